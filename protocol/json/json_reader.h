#pragma once

#include <cstdint>
#include <initializer_list>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/support/result.h"
#include "core/types.h"

namespace vat {

using Json = nlohmann::json;

/// Bounds of a text before a document is built from it.
struct JsonLimits {
  std::size_t bytes = 64 * 1024;
  std::size_t depth = 16;
  std::size_t values = 100'000;
};

/// Parses untrusted text. Refuses what is over a limit, duplicate keys, invalid UTF-8 and
/// anything after the document; the error's path is empty and its message names the place.
/// Codes: too_large, too_deep, too_many_values, duplicate_key, parse_error.
Result<Json> parse_json(std::string_view text, const JsonLimits& limits = {});

/// Greatest number of errors that are collected for one document; a reply stays small.
inline constexpr std::size_t kMaxReadErrors = 256;

/// Adds an error, unless there are kMaxReadErrors already.
void add_error(Errors& errors, std::string code, std::string path, std::string message);

/// JSON pointers (RFC 6901) of a member and of an array element.
std::string pointer_to(std::string_view parent, std::string_view key);
std::string pointer_to(std::string_view parent, std::size_t index);

/// Bounds for numbers that only have to be finite.
inline constexpr Real kAnyMin = std::numeric_limits<Real>::lowest();
inline constexpr Real kAnyMax = std::numeric_limits<Real>::max();

/// Checked reading of single values: nothing, and one error, where the value does not fit. Codes:
/// wrong_type, out_of_range, bad_text.
std::optional<Real> to_real(const Json& value, const std::string& path, Real min, Real max,
                            Errors& errors);
std::optional<std::uint64_t> to_count(const Json& value, const std::string& path, std::uint64_t min,
                                      std::uint64_t max, Errors& errors);
std::optional<std::string> to_text(const Json& value, const std::string& path,
                                   std::size_t max_bytes, Errors& errors);
std::optional<Vec3> to_vector(const Json& value, const std::string& path, Real min, Real max,
                              Errors& errors);
/// Null, and one error, unless the value is an array of `min` to `max` elements.
const Json* to_array(const Json& value, const std::string& path, std::size_t min, std::size_t max,
                     Errors& errors);

/// Checked reading of one JSON object. Errors are collected, not thrown: each wrong, missing or
/// unknown member adds one Error with its JSON pointer and the allowed range, and the read returns
/// the fallback (or a value in range), so that one pass reports everything. Codes, beside those
/// above: missing, unknown_member, unknown_name.
class ObjectReader {
 public:
  /// `path` is the JSON pointer of `value`; adds an error if `value` is not an object. The value
  /// and the errors must outlive this.
  ObjectReader(const Json& value, std::string path, Errors& errors);

  bool has(std::string_view key) const;
  /// The member, or null (and an error if `required`). Marks the key as known.
  const Json* member(std::string_view key, bool required = false);
  std::string path_of(std::string_view key) const;

  /// Finite number in [min, max]. Without a fallback the member is required. Same below.
  Real real(std::string_view key, Real min, Real max, std::optional<Real> fallback = {});
  std::uint64_t count(std::string_view key, std::uint64_t min, std::uint64_t max,
                      std::optional<std::uint64_t> fallback = {});
  bool boolean(std::string_view key, std::optional<bool> fallback = {});
  /// UTF-8 text of at most `max_bytes` bytes without control characters.
  std::string text(std::string_view key, std::size_t max_bytes,
                   const std::optional<std::string>& fallback = {});
  Vec3 vector(std::string_view key, Real min, Real max, const std::optional<Vec3>& fallback = {});
  /// The position of the member's text in `names`.
  std::size_t choice(std::string_view key, std::initializer_list<std::string_view> names,
                     std::optional<std::size_t> fallback = {});
  /// The member as an array of at most `max` elements; null where it is absent or wrong.
  const Json* array(std::string_view key, std::size_t max, bool required = false);

  /// Adds an error for every member that no call above asked for.
  void refuse_unknown();

 private:
  const Json* value_;
  std::string path_;
  Errors* errors_;
  std::vector<std::string> known_;
};

}  // namespace vat
