#include "protocol/printable.h"

#include <algorithm>

namespace vat {

std::string printable(std::string_view text) {
  constexpr std::size_t kMostBytes = 160;  // a line or two of a terminal
  std::string result(text.substr(0, kMostBytes));
  std::replace_if(
      result.begin(), result.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  if (text.size() > kMostBytes) result += "...";
  return result;
}

}  // namespace vat
