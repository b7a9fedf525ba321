#pragma once

#include <string>
#include <string_view>
#include <utility>

#include "core/support/nearest_name.h"
#include "core/support/result.h"
#include "core/types.h"

namespace vat {

/// Returns whether all components are finite and at most `limit` in magnitude.
inline bool are_at_most(const Vec3& value, Real limit) {
  return value.allFinite() && value.cwiseAbs().maxCoeff() <= limit;
}

/// Checks of single values of a scene. Each failed check adds one error that names the permitted
/// range. Codes: out_of_range, bad_text.
class RangeCheck {
 public:
  explicit RangeCheck(Errors& errors) : errors_(errors) {}

  void add(std::string code, std::string path, std::string message);
  /// Adds an error unknown_name, with a suggestion from the projections of the elements.
  template <class Range, class Projection>
  void add_unknown(std::string path, std::string rule, std::string_view wrong, const Range& range,
                   const Projection& name_of) {
    errors_.push_back(
        unknown_name(errors_, std::move(path), std::move(rule), wrong, range, name_of));
  }
  /// Returns whether the value is in the inclusive range. A NaN is outside.
  bool real(Real value, Real min, Real max, const std::string& path);
  bool vector(const Vec3& value, Real min, Real max, const std::string& path);
  /// Checks the length of a text. The reader of scene files checks UTF-8.
  bool text(const std::string& value, std::size_t max_bytes, bool empty_allowed,
            const std::string& path);

 private:
  Errors& errors_;
};

}  // namespace vat
