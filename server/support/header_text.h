#pragma once

#include <algorithm>
#include <cstddef>
#include <string_view>

/// Texts of HTTP headers. C++17, because the transport includes this header.
namespace vat {

/// Returns whether the texts are equal, except for the case of the letters from A to Z.
inline bool equal_ignoring_case(std::string_view a, std::string_view b) {
  const auto to_lower_case = [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](char x, char y) { return to_lower_case(x) == to_lower_case(y); });
}

/// Returns the text without spaces and tabs at its ends.
inline std::string_view without_spaces(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

/// Removes the part before the first separator, and the separator. Returns the part without spaces
/// at its ends. Without a separator, the part is the whole text.
inline std::string_view take_part(std::string_view& text, char separator) {
  const std::size_t end = std::min(text.find(separator), text.size());
  const std::string_view part = without_spaces(text.substr(0, end));
  text.remove_prefix(std::min(end + 1, text.size()));
  return part;
}

}  // namespace vat
