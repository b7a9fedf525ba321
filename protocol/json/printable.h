#pragma once

#include <string>
#include <string_view>

namespace vat {

/// Returns untrusted text for a message: printable ASCII, with a limited length.
std::string printable(std::string_view text);

}  // namespace vat
