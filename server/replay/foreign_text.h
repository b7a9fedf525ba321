#pragma once

#include <cstddef>
#include <string>

namespace vat {

/// Returns the text if it is UTF-8 of at most `most` bytes. Otherwise returns the first `most`
/// bytes as printable characters.
std::string fit_to_tell(const std::string& text, std::size_t most);

}  // namespace vat
