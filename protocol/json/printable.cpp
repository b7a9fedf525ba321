#include "protocol/json/printable.h"

#include <algorithm>

namespace vat {

std::string printable(std::string_view text) {
  constexpr std::size_t kMaxBytes = 160;  // a line or two of a terminal
  std::string result(text.substr(0, kMaxBytes));
  std::replace_if(
      result.begin(), result.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  if (text.size() > kMaxBytes) result += "...";
  return result;
}

}  // namespace vat
