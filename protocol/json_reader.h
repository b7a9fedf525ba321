#pragma once

#include <cstdint>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

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
Result<Json> parse_json(std::string_view text, const JsonLimits& limits = {});

/// Checked reading of one JSON object. Errors are collected, not thrown: each wrong, missing or
/// unknown member adds one Error with its JSON pointer and the allowed range, and the read returns
/// the fallback (or a value in range), so that one pass reports everything.
class ObjectReader {
 public:
  /// `path` is the JSON pointer of `value`; adds an error if `value` is not an object.
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
                   std::optional<std::string> fallback = {});
  Vec3 vector(std::string_view key, Real min, Real max, std::optional<Vec3> fallback = {});
  /// The position of the member's text in `names`.
  std::size_t choice(std::string_view key, std::initializer_list<std::string_view> names,
                     std::optional<std::size_t> fallback = {});

  /// Adds an error for every member that no call above asked for.
  void refuse_unknown();

 private:
  const Json* value_;
  std::string path_;
  Errors* errors_;
  std::vector<std::string> known_;
};

}  // namespace vat
