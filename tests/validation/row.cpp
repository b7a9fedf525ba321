#include "tests/validation/row.h"

#include <cmath>
#include <utility>

namespace vat::validation {

Tolerance within(Real value, std::string source) {
  return {Tolerance::Kind::absolute, value, std::move(source)};
}

Tolerance within_relative(Real value, std::string source) {
  return {Tolerance::Kind::relative, value, std::move(source)};
}

Tolerance at_most(std::string source) {
  return {Tolerance::Kind::at_most, 0, std::move(source)};
}

Tolerance at_least(std::string source) {
  return {Tolerance::Kind::at_least, 0, std::move(source)};
}

Tolerance reported(std::string cause) {
  return {Tolerance::Kind::reported, 0, std::move(cause)};
}

bool Row::passed() const {
  if (!std::isfinite(measured)) return false;
  switch (tolerance.kind) {
    case Tolerance::Kind::absolute:
      return std::abs(measured - reference) <= tolerance.value;
    case Tolerance::Kind::relative:
      return std::abs(measured - reference) <= tolerance.value * std::abs(reference);
    case Tolerance::Kind::at_most:
      return measured <= reference;
    case Tolerance::Kind::at_least:
      return measured >= reference;
    case Tolerance::Kind::reported:
      return true;
  }
  return false;
}

}  // namespace vat::validation
