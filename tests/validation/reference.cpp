#include "tests/validation/reference.h"

#include <fstream>
#include <stdexcept>

namespace vat::validation {

namespace {

Json read() {
  const char* name = VAT_SOURCE_DIR "/tests/validation/reference.json";
  std::ifstream file(name);
  if (!file) throw std::runtime_error(std::string(name) + ": cannot be read");
  return Json::parse(file);
}

}  // namespace

const Json& reference_at(const std::string& pointer) {
  static const Json document = read();
  const Json::json_pointer place(pointer);
  if (!document.contains(place)) throw std::out_of_range("reference.json has no " + pointer);
  return document.at(place);
}

Real reference(const std::string& pointer) {
  return reference_at(pointer).get<Real>();
}

Vec3 reference_vector(const std::string& pointer) {
  const auto values = reference_at(pointer).get<std::array<Real, 3>>();
  return {values[0], values[1], values[2]};
}

}  // namespace vat::validation
