#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "core/types.h"
#include "protocol/client/methods/invalid_value.h"

/// Values of messages from and to JSON, for the generated functions in methods.cpp.
namespace vat::client {

using Json = nlohmann::json;

/// Texts of the enumerators except the last one, `unknown`.
template <class Enumeration>
inline constexpr std::array<const char*, 0> kTexts{};

void require_object(const Json& json);

void read_json(const Json& json, bool& value);
void read_json(const Json& json, double& value);
void read_json(const Json& json, std::int64_t& value);
void read_json(const Json& json, std::uint32_t& value);
void read_json(const Json& json, std::uint64_t& value);
void read_json(const Json& json, std::string& value);
void read_json(const Json& json, Vec3& value);
void read_json(const Json& json, std::array<double, 4>& value);
/// Returns the element, or throws InvalidValue.
const Json& require_member(const Json& json, const char* name);
void require_array(const Json& json);

template <class Enumeration>
requires std::is_enum_v<Enumeration>
void read_json(const Json& json, Enumeration& value) {
  std::string text;
  read_json(json, text);
  std::size_t i = 0;
  while (i < kTexts<Enumeration>.size() && text != kTexts<Enumeration>[i]) ++i;
  value = static_cast<Enumeration>(i);  // past the end: unknown
}

template <class Element>
void read_json(const Json& json, std::vector<Element>& values) {
  require_array(json);
  values.resize(json.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    try {
      read_json(json[i], values[i]);
    } catch (const InvalidValue& error) {
      throw error.inside(std::to_string(i));
    }
  }
}

template <class Element>
void read_json(const Json& json, std::map<std::string, Element>& values) {
  require_object(json);
  values.clear();
  for (const auto& [key, element] : json.items()) {
    try {
      read_json(element, values[key]);
    } catch (const InvalidValue& error) {
      throw error.inside(key);
    }
  }
}

template <class Value>
void read_member(const Json& json, const char* name, Value& value) {
  const Json& member = require_member(json, name);
  try {
    read_json(member, value);
  } catch (const InvalidValue& error) {
    throw error.inside(name);
  }
}

/// An absent member and null are both empty.
template <class Value>
void read_member(const Json& json, const char* name, std::optional<Value>& value) {
  const auto member = json.find(name);
  value.reset();
  if (member == json.end() || member->is_null()) return;
  read_member(json, name, value.emplace(Value{}));
}

inline void read_member(const Json& json, const char* name, Json& value) {
  value = require_member(json, name);
}

inline void read_free_member(const Json& json, const char* name, Json& value) {
  value = json.value(name, Json());
}

inline void write_json(Json& json, bool value) {
  json = value;
}
inline void write_json(Json& json, double value) {
  json = value;
}
inline void write_json(Json& json, std::uint32_t value) {
  json = value;
}
inline void write_json(Json& json, std::uint64_t value) {
  json = value;
}
inline void write_json(Json& json, const std::string& value) {
  json = value;
}
inline void write_json(Json& json, const Json& value) {
  json = value;
}
inline void write_json(Json& json, const Vec3& value) {
  json = {value.x(), value.y(), value.z()};
}
inline void write_json(Json& json, const std::array<double, 4>& value) {
  json = value;
}

template <class Enumeration>
requires std::is_enum_v<Enumeration>
void write_json(Json& json, Enumeration value) {
  const auto i = static_cast<std::size_t>(value);
  if (i >= kTexts<Enumeration>.size()) {
    throw std::invalid_argument("an enumerator `unknown` cannot be sent");
  }
  json = kTexts<Enumeration>[i];
}

template <class Element>
void write_json(Json& json, const std::vector<Element>& values) {
  json = Json::array();
  for (const Element& value : values) write_json(json.emplace_back(), value);
}

template <class Value>
void write_member(Json& json, const char* name, const Value& value) {
  write_json(json[name], value);
}

template <class Value>
void write_member(Json& json, const char* name, const std::optional<Value>& value) {
  if (value) write_json(json[name], *value);
}

inline void write_member(Json& json, const char* name, const Json& value) {
  if (!value.is_null()) json[name] = value;
}

/// Calls the function of an event with its params.
template <class Event>
bool deliver(const Json& params, const std::function<void(const Event&)>& function) {
  if (!function) return true;
  Event event;
  read_json(params, event);
  function(event);
  return true;
}

}  // namespace vat::client
