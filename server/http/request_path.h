#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace vat {

/// Returns the decoded path of a request target ("/a b" for "/a%20b?c"). Returns nothing if the
/// target is not a path, or contains an invalid escape, a NUL, a backslash, or a "." or ".."
/// segment.
std::optional<std::string> request_path(std::string_view target);

}  // namespace vat
