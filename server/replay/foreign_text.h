#pragma once

#include <cstddef>
#include <string>

namespace vat {

/// Text that anybody may have written, as a message can tell it: itself where it is UTF-8 of at
/// most so many bytes, otherwise what is printable of its beginning.
std::string fit_to_tell(const std::string& text, std::size_t most);

}  // namespace vat
