#include "server/http/request_path.h"

#include <algorithm>
#include <cstddef>

namespace vat {

namespace {

std::optional<int> hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return std::nullopt;
}

std::optional<std::string> percent_decoded(std::string_view text) {
  std::string decoded;
  decoded.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      decoded += text[i];
      continue;
    }
    if (text.size() - i < 3) return std::nullopt;
    const std::optional<int> high = hex_digit(text[i + 1]);
    const std::optional<int> low = hex_digit(text[i + 2]);
    if (!high || !low) return std::nullopt;
    decoded += static_cast<char>(*high * 16 + *low);
    i += 2;
  }
  return decoded;
}

bool has_dot_segment(std::string_view path) {
  for (std::size_t begin = 1; begin <= path.size();) {
    const std::size_t end = std::min(path.find('/', begin), path.size());
    const std::string_view segment = path.substr(begin, end - begin);
    if (segment == "." || segment == "..") return true;
    begin = end + 1;
  }
  return false;
}

}  // namespace

std::optional<std::string> request_path(std::string_view target) {
  const std::string_view encoded = target.substr(0, target.find_first_of("?#"));
  if (encoded.empty() || encoded.front() != '/') return std::nullopt;
  std::optional<std::string> path = percent_decoded(encoded);
  if (!path) return std::nullopt;
  constexpr std::string_view kForbidden("\0\\", 2);
  if (path->find_first_of(kForbidden) != std::string::npos) return std::nullopt;
  if (has_dot_segment(*path)) return std::nullopt;
  return path;
}

}  // namespace vat
