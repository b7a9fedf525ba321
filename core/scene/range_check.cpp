#include "core/scene/range_check.h"

#include <cstdio>
#include <utility>

namespace vat {
namespace {

std::string range_text(Real min, Real max) {
  char text[80];
  std::snprintf(text, sizeof text, "from %.9g to %.9g", min, max);
  return text;
}

}  // namespace

void RangeCheck::add(std::string code, std::string path, std::string message) {
  errors_.push_back({std::move(code), std::move(path), std::move(message)});
}

bool RangeCheck::real(Real value, Real min, Real max, const std::string& path) {
  if (value >= min && value <= max) return true;
  add("out_of_range", path, "must be a number " + range_text(min, max));
  return false;
}

bool RangeCheck::vector(const Vec3& value, Real min, Real max, const std::string& path) {
  if ((value.array() >= min).all() && (value.array() <= max).all()) return true;
  add("out_of_range", path, "must be three numbers " + range_text(min, max));
  return false;
}

bool RangeCheck::text(const std::string& value, std::size_t max_bytes, bool empty_allowed,
                      const std::string& path) {
  if (value.size() <= max_bytes && (empty_allowed || !value.empty())) return true;
  add("bad_text", path,
      std::string("must be text of ") + (empty_allowed ? "at most " : "1 to ") +
          std::to_string(max_bytes) + " bytes");
  return false;
}

}  // namespace vat
