#pragma once

#include <string>
#include <string_view>

#include "protocol/json/json_reader.h"

namespace vat {

/// Whether UTF-8 text can be shown as somebody's name: something to see, and nothing that hides or
/// turns round what stands beside it (control characters, marks of direction, spaces of no width).
bool is_showable_name(std::string_view text);

/// A person's name: at most kMaxNameLength bytes, showable.
std::string read_person_name(ObjectReader& params, std::string_view key, Errors& errors);

}  // namespace vat
