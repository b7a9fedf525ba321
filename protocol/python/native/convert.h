#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/support/result.h"
#include "core/types.h"

namespace vat::python {

/// Throws vat.InputError with the errors.
[[noreturn]] void raise(const Errors& errors);

/// Returns the value. Throws vat.InputError with the errors of the result.
template <class T>
T value_of(Result<T> result) {
  if (!result) raise(result.errors());
  return std::move(result).value();
}
void require(const Status& status);

/// Returns an array of `count` rows of three numbers or, without `rows`, of `count` numbers. The
/// array is read-only, and references the memory of `base`.
template <class Number>
pybind11::array read_only_array(const Number* data, std::size_t count, bool rows,
                                const pybind11::object& base) {
  std::vector<pybind11::ssize_t> shape{static_cast<pybind11::ssize_t>(count)};
  if (rows) shape.push_back(3);
  pybind11::array array(pybind11::dtype::of<Number>(), shape, data, base);
  array.attr("flags").attr("writeable") = false;
  return array;
}

/// Returns a read-only array that owns `values`.
template <class Number>
pybind11::array own_array(std::vector<Number> values, bool rows = false) {
  auto* owner = new std::vector<Number>(std::move(values));
  const pybind11::capsule base(
      owner, [](void* pointer) { delete static_cast<std::vector<Number>*>(pointer); });
  return read_only_array(owner->data(), owner->size() / (rows ? 3 : 1), rows, base);
}

/// Returns the content, which is valid as long as `bytes` exists.
std::span<const std::uint8_t> bytes_of(const pybind11::bytes& bytes);

pybind11::tuple to_tuple(const Vec3& vector);
pybind11::tuple to_tuple(const Quat& orientation);  ///< (w, x, y, z)
/// Return a vector of three numbers, or an orientation (w, x, y, z). Throw ValueError that names
/// the argument.
Vec3 to_vector(const pybind11::handle& value, const char* name);
Quat to_orientation(const pybind11::handle& value, const char* name);

}  // namespace vat::python
