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
/// A pattern object matches an object that has at least its members. A pattern list matches a list
/// of equal length. Other values must be equal. "$any" matches anything; "$name" matches anything
/// the first time and an equal value after that. A pattern object with the following members is a
/// test of the value: $eq $ne $ge $gt $le $lt: comparison with an operand, which may use captures
/// $near: [x, e]: a number within e of x; if x is a list, a list whose elements are each within e
/// of the same element of x $turned: [q, e], an orientation [w, x, y, z] at most e rad from q
/// $type: "number", "string", "boolean", ... $contains: a text with this part $size: a text or list
/// of this length $has: a list with a matching element $each: a list of matching elements only
/// $absent: true if there must be no such member $capture: if all other tests of the object pass,
/// stores the value under this name and replaces an earlier capture
std::optional<std::string> mismatch(const Json& pattern, const Json& value, Captures& captures);

}  // namespace vat::script
