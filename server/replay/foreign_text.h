#pragma once

#include <cstddef>
#include <string>

namespace vat {

/// Returns the text itself if it is UTF-8 of at most `most` bytes, or else the printable characters
/// of its beginning.
std::string fit_to_tell(const std::string& text, std::size_t most);

}  // namespace vat
