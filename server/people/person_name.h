#pragma once

#include <string>
#include <string_view>

#include "protocol/json/json_reader.h"

namespace vat {

/// Returns whether a UTF-8 text can be displayed as a name. The text must have visible characters.
/// It must not have characters that hide or reorder text (control characters, direction marks,
/// zero-width spaces).
bool is_showable_name(std::string_view text);

/// Returns a name of at most kMaxNameLength bytes for which is_showable_name() is true.
std::string read_person_name(ObjectReader& params, std::string_view key, Errors& errors);

}  // namespace vat
