#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>

namespace vat::script {

using Json = nlohmann::json;
using Captures = std::map<std::string, Json>;

/// Error in a script, in contrast to a message that does not match.
struct ScriptError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Returns `value` with replaced captures:
/// - "$name": value of the capture `name`.
/// - {"$add": [a, b]}: sum of a and b.
/// - {"$repeat": [text, count]}: `text`, repeated `count` times.
/// - {"$join": [...]}: concatenation of the texts.
///
/// Throws ScriptError for a name without a capture.
Json substitute(const Json& value, const Captures& captures);

/// Returns the reason why `value` does not match `pattern`, with its JSON pointer, or nothing. A
/// match adds captures to `captures`.
///
/// A pattern object matches an object with at least the same members. A pattern list matches a list
/// of equal length. Other values must be equal. "$any" matches any value. "$name" matches any value
/// at the first use, and an equal value at later uses. A pattern object with the following members
/// tests the value:
/// - $eq, $ne, $ge, $gt, $le, $lt: comparison with an operand, which may use captures.
/// - $near: [x, e]: a number within e of x, or a list if x is a list.
/// - $turned: [q, e]: an orientation [w, x, y, z] at most e rad from q.
/// - $type: "number", "string", "boolean", ...
/// - $contains: a text that contains this text.
/// - $size: a text or list of this length.
/// - $has: a list with a matching element.
/// - $each: a list with only matching elements.
/// - $absent: true if the member must be absent.
/// - $capture: stores the value under this name if all other tests of the object succeed.
std::optional<std::string> mismatch(const Json& pattern, const Json& value, Captures& captures);

}  // namespace vat::script
