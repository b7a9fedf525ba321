#include "protocol/client/methods/json_value.h"

#include <utility>

namespace vat::client {
namespace {

template <class Number>
void read_integer(const Json& json, Number& value) {
  if (!json.is_number_integer()) throw InvalidValue("is not an integer");
  const bool fits = json.is_number_unsigned() ? std::in_range<Number>(json.get<std::uint64_t>())
                                              : std::in_range<Number>(json.get<std::int64_t>());
  if (!fits) throw InvalidValue("is outside the range of its type");
  value = json.get<Number>();
}

void read_numbers(const Json& json, double* values, std::size_t count) {
  require_array(json);
  if (json.size() != count) throw InvalidValue("needs " + std::to_string(count) + " numbers");
  for (std::size_t i = 0; i < count; ++i) read_json(json[i], values[i]);
}

}  // namespace

void require_object(const Json& json) {
  if (!json.is_object()) throw InvalidValue("is not an object");
}

void require_array(const Json& json) {
  if (!json.is_array()) throw InvalidValue("is not a list");
}

const Json& require_member(const Json& json, const char* name) {
  const auto member = json.find(name);
  if (member == json.end()) throw InvalidValue("is missing", std::string("/") + name);
  return *member;
}

void read_json(const Json& json, bool& value) {
  if (!json.is_boolean()) throw InvalidValue("is not a bool");
  value = json.get<bool>();
}

void read_json(const Json& json, double& value) {
  if (!json.is_number()) throw InvalidValue("is not a number");
  value = json.get<double>();
}

void read_json(const Json& json, std::int64_t& value) {
  read_integer(json, value);
}

void read_json(const Json& json, std::uint32_t& value) {
  read_integer(json, value);
}

void read_json(const Json& json, std::uint64_t& value) {
  read_integer(json, value);
}

void read_json(const Json& json, std::string& value) {
  if (!json.is_string()) throw InvalidValue("is not a text");
  value = json.get<std::string>();
}

void read_json(const Json& json, Vec3& value) {
  read_numbers(json, value.data(), 3);
}

void read_json(const Json& json, std::array<double, 4>& value) {
  read_numbers(json, value.data(), value.size());
}

}  // namespace vat::client
