#include "protocol/json/json_reader.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

#include "core/support/nearest_name.h"

namespace vat {
namespace {

std::string to_message(Real value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.9g", value);
  return buffer;
}

std::string number_rule(Real min, Real max) {
  if (min == kAnyMin && max == kAnyMax) return "must be a finite number";
  return "must be a number from " + to_message(min) + " to " + to_message(max);
}

std::string count_rule(std::uint64_t min, std::uint64_t max) {
  return "must be a whole number from " + std::to_string(min) + " to " + std::to_string(max);
}

/// Returns the number if it is an integer and not negative. JSON does not distinguish 2 and 2.0.
std::optional<std::uint64_t> whole_number(const Json& value) {
  if (value.is_number_unsigned()) return value.get<std::uint64_t>();
  if (!value.is_number_float()) return {};
  constexpr Real kExact = 9007199254740992.0;  // 2^53: larger integers are rounded
  const Real number = value.get<Real>();
  if (!(number >= 0 && number <= kExact) || std::trunc(number) != number) return {};
  return static_cast<std::uint64_t>(number);
}

bool is_control(char c) {
  return static_cast<unsigned char>(c) < ' ' || c == '\x7f';
}

}  // namespace

void add_error(Errors& errors, Error error) {
  if (errors.size() < kMaxReadErrors) errors.push_back(std::move(error));
}

void add_error(Errors& errors, std::string code, std::string path, std::string message) {
  add_error(errors, Error{std::move(code), std::move(path), std::move(message)});
}

std::string pointer_to(std::string_view parent, std::string_view key) {
  std::string pointer(parent);
  pointer += '/';
  for (const char c : key) {
    if (c == '~') {
      pointer += "~0";
    } else if (c == '/') {
      pointer += "~1";
    } else {
      pointer += c;
    }
  }
  return pointer;
}

std::string pointer_to(std::string_view parent, std::size_t index) {
  return pointer_to(parent, std::to_string(index));
}

std::optional<Real> to_real(const Json& value, const std::string& path, Real min, Real max,
                            Errors& errors) {
  if (!value.is_number()) {
    add_error(errors, "wrong_type", path, number_rule(min, max));
    return {};
  }
  const Real number = value.get<Real>();
  if (!std::isfinite(number) || number < min || number > max) {
    add_error(errors, "out_of_range", path, number_rule(min, max));
    return {};
  }
  return number;
}

std::optional<std::uint64_t> to_count(const Json& value, const std::string& path, std::uint64_t min,
                                      std::uint64_t max, Errors& errors) {
  if (!value.is_number()) {
    add_error(errors, "wrong_type", path, count_rule(min, max));
    return {};
  }
  const std::optional<std::uint64_t> number = whole_number(value);
  if (!number || *number < min || *number > max) {
    add_error(errors, "out_of_range", path, count_rule(min, max));
    return {};
  }
  return number;
}

std::optional<std::string> to_text(const Json& value, const std::string& path,
                                   std::size_t max_bytes, Errors& errors) {
  const std::string rule = "must be text of at most " + std::to_string(max_bytes) + " bytes";
  if (!value.is_string()) {
    add_error(errors, "wrong_type", path, rule);
    return {};
  }
  const auto& text = value.get_ref<const std::string&>();
  if (text.size() > max_bytes) {
    add_error(errors, "out_of_range", path, rule);
    return {};
  }
  if (std::any_of(text.begin(), text.end(), is_control)) {
    add_error(errors, "bad_text", path, "must be text without control characters");
    return {};
  }
  return text;
}

std::optional<Vec3> to_vector(const Json& value, const std::string& path, Real min, Real max,
                              Errors& errors) {
  if (!value.is_array() || value.size() != 3) {
    add_error(errors, "wrong_type", path, "must be a list [x, y, z] of three numbers");
    return {};
  }
  Vec3 vector = Vec3::Zero();
  bool complete = true;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto component = to_real(value[axis], pointer_to(path, axis), min, max, errors);
    complete = complete && component;
    vector[static_cast<Eigen::Index>(axis)] = component.value_or(0);
  }
  if (!complete) return {};
  return vector;
}

const Json* to_array(const Json& value, const std::string& path, std::size_t min, std::size_t max,
                     Errors& errors) {
  const std::string rule = min == max ? "must be a list of " + std::to_string(min) + " elements"
                                      : "must be a list of " + std::to_string(min) + " to " +
                                            std::to_string(max) + " elements";
  if (!value.is_array()) {
    add_error(errors, "wrong_type", path, rule);
    return nullptr;
  }
  if (value.size() < min || value.size() > max) {
    add_error(errors, "out_of_range", path, rule);
    return nullptr;
  }
  return &value;
}

Json to_json(const Vec3& vector) {
  return Json::array({vector.x(), vector.y(), vector.z()});
}

Json to_json(const Quat& orientation) {
  return Json::array({orientation.w(), orientation.x(), orientation.y(), orientation.z()});
}

ObjectReader::ObjectReader(const Json& value, std::string path, Errors& errors)
    : value_(value.is_object() ? &value : nullptr), path_(std::move(path)), errors_(&errors) {
  if (value_ == nullptr) add_error(errors, "wrong_type", path_, "must be an object");
}

bool ObjectReader::has(std::string_view key) {
  suggested_.emplace_back(key);
  return value_ != nullptr && value_->contains(key);
}

const Json* ObjectReader::member(std::string_view key, bool required) {
  known_.emplace_back(key);
  suggested_.emplace_back(key);
  if (value_ == nullptr) return nullptr;  // reported once, by the constructor
  const auto found = value_->find(key);
  if (found != value_->end()) return &*found;
  if (required) add_error(*errors_, "missing", path_of(key), "must be given");
  return nullptr;
}

std::string ObjectReader::path_of(std::string_view key) const {
  return pointer_to(path_, key);
}

Real ObjectReader::real(std::string_view key, Real min, Real max, std::optional<Real> fallback) {
  const Real otherwise = fallback.value_or(std::clamp(Real{0}, min, max));
  const Json* value = member(key, !fallback);
  if (value == nullptr) return otherwise;
  return to_real(*value, path_of(key), min, max, *errors_).value_or(otherwise);
}

std::uint64_t ObjectReader::count(std::string_view key, std::uint64_t min, std::uint64_t max,
                                  std::optional<std::uint64_t> fallback) {
  const std::uint64_t otherwise = fallback.value_or(min);
  const Json* value = member(key, !fallback);
  if (value == nullptr) return otherwise;
  return to_count(*value, path_of(key), min, max, *errors_).value_or(otherwise);
}

bool ObjectReader::boolean(std::string_view key, std::optional<bool> fallback) {
  const Json* value = member(key, !fallback);
  if (value == nullptr) return fallback.value_or(false);
  if (value->is_boolean()) return value->get<bool>();
  add_error(*errors_, "wrong_type", path_of(key), "must be true or false");
  return fallback.value_or(false);
}

std::string ObjectReader::text(std::string_view key, std::size_t max_bytes,
                               const std::optional<std::string>& fallback) {
  const Json* value = member(key, !fallback);
  if (value == nullptr) return fallback.value_or("");
  const auto text = to_text(*value, path_of(key), max_bytes, *errors_);
  return text ? *text : fallback.value_or("");
}

Vec3 ObjectReader::vector(std::string_view key, Real min, Real max,
                          const std::optional<Vec3>& fallback) {
  Vec3 otherwise = fallback.value_or(Vec3::Constant(std::clamp(Real{0}, min, max)));
  const Json* value = member(key, !fallback);
  if (value == nullptr) return otherwise;
  return to_vector(*value, path_of(key), min, max, *errors_).value_or(otherwise);
}

template <class Names>
std::size_t ObjectReader::choose(std::string_view key, const Names& names,
                                 std::optional<std::size_t> fallback) {
  const Json* value = member(key, !fallback);
  if (value == nullptr) return fallback.value_or(0);
  std::string rule = "must be one of";
  std::size_t position = 0;
  for (const std::string_view name : names) {
    if (value->is_string() && value->get_ref<const std::string&>() == name) return position;
    rule += (position++ == 0 ? " \"" : ", \"") + std::string(name) + '"';
  }
  if (value->is_string()) {
    add_error(*errors_, unknown_name(*errors_, path_of(key), rule,
                                     value->get_ref<const std::string&>(), names, std::identity()));
  } else {
    add_error(*errors_, "wrong_type", path_of(key), rule);
  }
  return fallback.value_or(0);
}

std::size_t ObjectReader::choice(std::string_view key,
                                 std::initializer_list<std::string_view> names,
                                 std::optional<std::size_t> fallback) {
  return choose(key, names, fallback);
}

std::size_t ObjectReader::choice(std::string_view key, std::span<const char* const> names,
                                 std::optional<std::size_t> fallback) {
  return choose(key, names, fallback);
}

const Json* ObjectReader::array(std::string_view key, std::size_t max, bool required) {
  const Json* value = member(key, required);
  return value == nullptr ? nullptr : to_array(*value, path_of(key), 0, max, *errors_);
}

/// Returns the known member that `key` can mean. Members that are given are not meant.
std::string ObjectReader::suggest_member(std::string_view key) const {
  if (errors_->size() >= kMaxSuggestions) return {};
  NearestName nearest(key);
  for (const std::string& name : suggested_) {
    if (!value_->contains(name)) nearest.consider(name);
  }
  return nearest.suggestion();
}

void ObjectReader::refuse_unknown() {
  if (value_ == nullptr) return;
  for (const auto& [key, value] : value_->items()) {
    if (std::find(known_.begin(), known_.end(), key) == known_.end()) {
      add_error(*errors_, with_suggestion({"unknown_member", path_of(key), "is not a known member"},
                                          suggest_member(key)));
    }
  }
}

}  // namespace vat
