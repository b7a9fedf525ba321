#pragma once

#include <string>
#include <string_view>

#include "protocol/json/json_reader.h"

namespace vat {

/// Whether a UTF-8 text can be shown as a name: it has visible characters, and none that hide or
/// reorder adjacent text (control characters, direction marks, zero-width spaces).
bool is_showable_name(std::string_view text);

/// Reads a name of at most kMaxNameLength bytes that is_showable_name().
std::string read_person_name(ObjectReader& params, std::string_view key, Errors& errors);

}  // namespace vat
