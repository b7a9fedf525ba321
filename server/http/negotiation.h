#pragma once

#include <array>
#include <string_view>

#include "core/support/names.h"

namespace vat {

/// Content coding of a response (RFC 9110, section 8.4.1).
enum class Encoding { identity, gzip, brotli };
template <>
inline constexpr std::array kNamesOf<Encoding>{"identity", "gzip", "br"};

/// Returns the weight that a header Accept-Encoding gives to the encoding, from 0 (not acceptable)
/// to 1. `identity` is acceptable unless the header excludes it.
double weight_of(Encoding encoding, std::string_view accept_encoding);

/// Returns whether a header If-None-Match contains the tag (with its quotes) or "*".
bool contains_tag(std::string_view if_none_match, std::string_view tag);

}  // namespace vat
