#pragma once

#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>
#include <system_error>

#include "core/support/check.h"

namespace vat {

/// Appends a number with the fewest digits from which the same bits can be read.
template <class Number>
void append_number(std::string& text, Number value) {
  char buffer[32];
  const std::to_chars_result result = std::to_chars(buffer, buffer + sizeof buffer, value);
  VAT_CHECK(result.ec == std::errc{});
  text.append(buffer, result.ptr);
}

/// Appends a hash as 16 hexadecimal digits.
void append_hash(std::string& text, std::uint64_t hash);

/// Appends a CSV field (RFC 4180). Adds quotes only if necessary.
void append_csv_field(std::string& text, std::string_view field);

}  // namespace vat
