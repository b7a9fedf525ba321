#pragma once

#include <string>

#include "core/support/result.h"
#include "core/types.h"

namespace vat {

/// True if all components are finite and at most `limit` in magnitude.
inline bool are_at_most(const Vec3& value, Real limit) {
  return value.allFinite() && value.cwiseAbs().maxCoeff() <= limit;
}

/// Checks of single values of a scene; each adds one error that names the range. Codes:
/// out_of_range, bad_text.
class RangeCheck {
 public:
  explicit RangeCheck(Errors& errors) : errors_(errors) {}

  void add(std::string code, std::string path, std::string message);
  /// True where the value fits. Ranges include their ends; a NaN is outside.
  bool real(Real value, Real min, Real max, const std::string& path);
  bool vector(const Vec3& value, Real min, Real max, const std::string& path);
  /// UTF-8 is the reader's to check; here the length counts, and `empty_allowed`.
  bool text(const std::string& value, std::size_t max_bytes, bool empty_allowed,
            const std::string& path);

 private:
  Errors& errors_;
};

}  // namespace vat
