#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>

namespace vat::script {

using Json = nlohmann::json;
using Captures = std::map<std::string, Json>;

/// A mistake in a script, as opposed to a message that does not match.
struct ScriptError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Returns `value` with every captured name replaced by its value: "$name" by the capture,
/// {"$add": [a, b]} by a sum, {"$repeat": [text, count]} by `text` so many times, {"$join": [...]}
/// by one text. Throws ScriptError for a name without a capture.
Json substitute(const Json& value, const Captures& captures);

/// Returns the reason why `value` does not match `pattern`, with its JSON pointer, or nothing. A
/// match adds its captures.
///
/// An object matches one that has at least the pattern's members; a list one of equal length; other
/// values must be equal. "$any" matches anything; "$name" matches anything the first time and an
/// equal value after that. An object whose members begin with $ tests:
///   $eq $ne $ge $gt $le $lt: comparison with an operand, which may use captures
///   $near: [x, e], a number within e of x, or a list of numbers each within e of that in x
///   $turned: [q, e], an orientation [w, x, y, z] at most e rad from q
///   $type: "number", "string", "boolean", ...
///   $contains: a text with this part              $size: a text or list of this length
///   $has: a list with a matching element          $each: a list of matching elements only
///   $absent: true if there must be no such member
///   $capture: keeps the value under a name in place of an earlier one, once all tests beside it
///   hold
std::optional<std::string> mismatch(const Json& pattern, const Json& value, Captures& captures);

}  // namespace vat::script
