#include "protocol/python/native/convert.h"

#include <array>
#include <cmath>
#include <string_view>

namespace py = pybind11;

namespace vat::python {
namespace {

template <std::size_t count>
std::array<Real, count> to_numbers(const py::handle& value, const char* name) {
  std::array<Real, count> numbers{};
  const std::string fault =
      std::string(name) + " must have " + std::to_string(count) + " finite numbers";
  if (!py::isinstance<py::sequence>(value) && !py::isinstance<py::array>(value)) {
    throw py::value_error(fault);
  }
  try {
    const auto list = py::list(py::reinterpret_borrow<py::object>(value));
    if (list.size() != count) throw py::value_error(fault);
    for (std::size_t i = 0; i < count; ++i) numbers[i] = list[i].cast<Real>();
  } catch (const py::cast_error&) {
    throw py::value_error(fault);
  }
  for (const Real number : numbers) {
    if (!std::isfinite(number)) throw py::value_error(fault);
  }
  return numbers;
}

}  // namespace

void raise(const Errors& errors) {
  py::list list;
  for (const Error& error : errors) {
    list.append(py::make_tuple(error.code, error.path, error.message, error.suggestion));
  }
  const py::object type = py::module_::import("vat.errors").attr("InputError");
  PyErr_SetObject(type.ptr(), type(list).ptr());
  throw py::error_already_set();
}

void require(const Status& status) {
  if (!status) raise(status.errors());
}

std::span<const std::uint8_t> bytes_of(const py::bytes& bytes) {
  const auto text = static_cast<std::string_view>(bytes);
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

py::tuple to_tuple(const Vec3& vector) {
  return py::make_tuple(vector.x(), vector.y(), vector.z());
}

py::tuple to_tuple(const Quat& orientation) {
  return py::make_tuple(orientation.w(), orientation.x(), orientation.y(), orientation.z());
}

Vec3 to_vector(const py::handle& value, const char* name) {
  const auto [x, y, z] = to_numbers<3>(value, name);
  return {x, y, z};
}

Quat to_orientation(const py::handle& value, const char* name) {
  const auto [w, x, y, z] = to_numbers<4>(value, name);
  const Quat orientation(w, x, y, z);
  if (std::abs(orientation.norm() - 1) > 1e-6) {
    throw py::value_error(std::string(name) + " must be a unit quaternion (w, x, y, z)");
  }
  return orientation.normalized();
}

}  // namespace vat::python
