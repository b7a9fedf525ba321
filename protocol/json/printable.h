#pragma once

#include <string>
#include <string_view>

namespace vat {

/// Foreign text made fit for a message: plain ASCII and short.
std::string printable(std::string_view text);

}  // namespace vat
