#include "server/people/person_name.h"

#include <algorithm>
#include <bit>
#include <cstdint>

#include "core/limits.h"

namespace vat {
namespace {

/// The code point at the front of valid UTF-8, which is taken off.
char32_t take_code_point(std::string_view& text) {
  const auto first = static_cast<std::uint8_t>(text.front());
  const auto ones = static_cast<std::size_t>(std::countl_one(first));
  const std::size_t length = std::clamp<std::size_t>(ones, 1, text.size());
  char32_t point = first & (0xFFu >> ones);
  for (std::size_t i = 1; i < length; ++i) {
    point = (point << 6) | (static_cast<std::uint8_t>(text[i]) & 0x3Fu);
  }
  text.remove_prefix(length);
  return point;
}

bool is_space(char32_t point) {
  return point == U' ' || point == U'\u00A0' || point == U'\u3000' ||
         (point >= U'\u2000' && point <= U'\u200A') || point == U'\u202F' || point == U'\u205F' ||
         point == U'\u1680';
}

bool is_hidden(char32_t point) {
  struct Range {
    char32_t first, last;
  };
  constexpr Range kHidden[] = {
      {0x00, 0x1F},     {0x7F, 0x9F},     {0xAD, 0xAD},       {0x61C, 0x61C},
      {0x180E, 0x180E}, {0x200B, 0x200F}, {0x2028, 0x202E},   {0x2060, 0x206F},
      {0xFEFF, 0xFEFF}, {0xFFF0, 0xFFFB}, {0xE0000, 0xE0FFF},
  };
  return std::ranges::any_of(
      kHidden, [&](const Range& range) { return range.first <= point && point <= range.last; });
}

}  // namespace

bool is_showable_name(std::string_view text) {
  bool shows = false;
  while (!text.empty()) {
    const char32_t point = take_code_point(text);
    if (is_hidden(point)) return false;
    shows = shows || !is_space(point);
  }
  return shows;
}

std::string read_person_name(ObjectReader& params, std::string_view key, Errors& errors) {
  const std::size_t before = errors.size();
  std::string name = params.text(key, kMaxNameLength);
  if (errors.size() == before && !is_showable_name(name)) {
    add_error(errors, "bad_text", params.path_of(key),
              "must contain a visible character, and no control characters or direction marks");
  }
  return name;
}

}  // namespace vat
