#pragma once

#include <string>
#include <string_view>

namespace vat {

/// Returns untrusted text as printable ASCII of limited length, for messages.
std::string printable(std::string_view text);

}  // namespace vat
