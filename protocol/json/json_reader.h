#pragma once

#include <cstdint>
#include <initializer_list>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/support/result.h"
#include "core/types.h"

namespace vat {

using Json = nlohmann::json;

/// Limits of a JSON text. The parser checks the limits before it allocates values.
struct JsonLimits {
  std::size_t bytes = 64 * 1024;
  std::size_t depth = 16;
  std::size_t values = 100'000;
};

/// Parses untrusted text. Rejects texts over a limit, duplicate keys, invalid UTF-8, and content
/// after the document. The error has an empty path, and its message contains the position. Error
/// codes: too_large, too_deep, too_many_values, duplicate_key, parse_error.
Result<Json> parse_json(std::string_view text, const JsonLimits& limits = {});

/// Greatest number of errors collected for one document. Limits the size of a reply.
inline constexpr std::size_t kMaxReadErrors = 256;

/// Adds an error if `errors` contains fewer than kMaxReadErrors errors.
void add_error(Errors& errors, Error error);
void add_error(Errors& errors, std::string code, std::string path, std::string message);

/// Returns the JSON pointer (RFC 6901) of a member or of an array element.
std::string pointer_to(std::string_view parent, std::string_view key);
std::string pointer_to(std::string_view parent, std::size_t index);

/// Bounds for all finite numbers.
inline constexpr Real kAnyMin = std::numeric_limits<Real>::lowest();
inline constexpr Real kAnyMax = std::numeric_limits<Real>::max();

/// Return one value. If the value is invalid, add one error and return nothing. Error codes:
/// wrong_type, out_of_range, bad_text.
std::optional<Real> to_real(const Json& value, const std::string& path, Real min, Real max,
                            Errors& errors);
std::optional<std::uint64_t> to_count(const Json& value, const std::string& path, std::uint64_t min,
                                      std::uint64_t max, Errors& errors);
std::optional<std::string> to_text(const Json& value, const std::string& path,
                                   std::size_t max_bytes, Errors& errors);
std::optional<Vec3> to_vector(const Json& value, const std::string& path, Real min, Real max,
                              Errors& errors);
/// Returns null and adds one error if the value is not an array of `min` to `max` elements.
const Json* to_array(const Json& value, const std::string& path, std::size_t min, std::size_t max,
                     Errors& errors);

/// Return [x, y, z], or an orientation [w, x, y, z].
Json to_json(const Vec3& vector);
Json to_json(const Quat& orientation);

/// Reader of one JSON object. Each wrong, missing or unknown member adds one error with its JSON
/// pointer and valid range. The function then returns the fallback or a value in range, so that one
/// pass reports all errors. Additional error codes: missing, unknown_member, unknown_name.
class ObjectReader {
 public:
  /// Adds an error if `value` is not an object. `path` is the JSON pointer of `value`. `value` and
  /// `errors` must outlive the reader.
  ObjectReader(const Json& value, std::string path, Errors& errors);

  /// Returns whether the member is present. Does not mark the key as known.
  bool has(std::string_view key);
  /// Returns the member, or null if the member is absent. Adds an error if the member is absent and
  /// `required`. Marks the key as known.
  const Json* member(std::string_view key, bool required = false);
  std::string path_of(std::string_view key) const;

  /// Returns a finite number in [min, max]. Without a fallback, the member is required. The same
  /// rule applies to all functions with a fallback.
  Real real(std::string_view key, Real min, Real max, std::optional<Real> fallback = {});
  std::uint64_t count(std::string_view key, std::uint64_t min, std::uint64_t max,
                      std::optional<std::uint64_t> fallback = {});
  bool boolean(std::string_view key, std::optional<bool> fallback = {});
  /// Returns UTF-8 text of at most `max_bytes` bytes without control characters.
  std::string text(std::string_view key, std::size_t max_bytes,
                   const std::optional<std::string>& fallback = {});
  Vec3 vector(std::string_view key, Real min, Real max, const std::optional<Vec3>& fallback = {});
  /// Returns the index of the member's text in `names`.
  std::size_t choice(std::string_view key, std::initializer_list<std::string_view> names,
                     std::optional<std::size_t> fallback = {});
  std::size_t choice(std::string_view key, std::span<const char* const> names,
                     std::optional<std::size_t> fallback = {});
  /// Returns an array of at most `max` elements, or null if the member is absent or invalid.
  const Json* array(std::string_view key, std::size_t max, bool required = false);

  /// Adds an error for every member that was not read before.
  void refuse_unknown();

 private:
  template <class Names>
  std::size_t choose(std::string_view key, const Names& names, std::optional<std::size_t> fallback);
  std::string suggest_member(std::string_view key) const;

  const Json* value_;
  std::string path_;
  Errors* errors_;
  std::vector<std::string> known_;
  std::vector<std::string> suggested_;  // names that has() was called with, or known
};

}  // namespace vat
