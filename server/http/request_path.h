#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace vat {

/// The decoded path of a request target ("/a%20b?c" gives "/a b"). Nothing where the target is not
/// a path, has a broken escape, a NUL or a backslash, or a "." or ".." segment.
std::optional<std::string> request_path(std::string_view target);

}  // namespace vat
