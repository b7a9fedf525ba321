#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace vat {

/// Returns the decoded path of a request target ("/a%20b?c" gives "/a b"). Returns nothing if the
/// target is not a path, or has an invalid escape, a NUL, a backslash, or a "." or ".." segment.
std::optional<std::string> request_path(std::string_view target);

}  // namespace vat
