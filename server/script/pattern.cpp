#include "server/script/pattern.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace vat::script {
namespace {

bool is_name(const Json& value) {
  return value.is_string() && value.get_ref<const std::string&>().rfind('$', 0) == 0;
}

bool is_test(const Json& value) {
  return value.is_object() && !value.empty() && value.begin().key().rfind('$', 0) == 0;
}

/// The two operands of {"$key": [a, b]}, or nothing if `value` has another form.
const Json* operands(const Json& value, const char* key) {
  if (!value.is_object() || value.size() != 1 || !value.contains(key)) return nullptr;
  const Json& list = value[key];
  if (!list.is_array() || list.size() != 2) {
    throw ScriptError(std::string(key) + " needs a list of two");
  }
  return &list;
}

Json sum(const Json& a, const Json& b) {
  if (!a.is_number() || !b.is_number()) throw ScriptError("$add needs two numbers");
  if (a.is_number_integer() && b.is_number_integer()) {
    return a.get<std::int64_t>() + b.get<std::int64_t>();
  }
  return a.get<double>() + b.get<double>();
}

std::string repeated(const Json& text, const Json& count) {
  if (!text.is_string() || !count.is_number_unsigned()) {
    throw ScriptError("$repeat needs a text and a count");
  }
  std::string result;
  for (std::size_t i = 0; i < count.get<std::size_t>(); ++i) result += text.get<std::string>();
  return result;
}

std::string joined(const Json& parts, const Captures& captures) {
  std::string result;
  for (const Json& part : parts) {
    const Json value = substitute(part, captures);
    result += value.is_string() ? value.get<std::string>() : value.dump();
  }
  return result;
}

std::string shown(const Json& value) {
  constexpr std::size_t kMaxLength = 2000;  // the part that tells, in a log
  std::string text = value.dump(-1, ' ', true, Json::error_handler_t::replace);
  if (text.size() > kMaxLength) text = text.substr(0, kMaxLength) + "...";
  return text;
}

/// Numbers within `error`, or lists of such.
bool is_near(const Json& value, const Json& wanted, double error) {
  if (wanted.is_number()) {
    return value.is_number() && std::abs(value.get<double>() - wanted.get<double>()) <= error;
  }
  if (!wanted.is_array()) throw ScriptError("$near needs a number or a list of numbers");
  if (!value.is_array() || value.size() != wanted.size()) return false;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (!is_near(value[i], wanted[i], error)) return false;
  }
  return true;
}

/// Returns the normalised quaternion, or nothing if the value is not one.
std::optional<std::array<double, 4>> unit_quaternion(const Json& value) {
  if (!value.is_array() || value.size() != 4) return {};
  std::array<double, 4> numbers{};
  double square = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    if (!value[i].is_number()) return {};
    numbers[i] = value[i].get<double>();
    square += numbers[i] * numbers[i];
  }
  if (!(square > 0)) return {};
  for (double& number : numbers) number /= std::sqrt(square);
  return numbers;
}

/// The angle of the rotation from one orientation to the other [rad]; infinite where the value is
/// no quaternion. q and -q are the same orientation.
double angle_between(const Json& value, const Json& wanted) {
  const auto b = unit_quaternion(wanted);
  if (!b) throw ScriptError("$turned needs a quaternion [w, x, y, z] and an angle");
  const auto a = unit_quaternion(value);
  if (!a) return std::numeric_limits<double>::infinity();
  double same = 0;
  double opposite = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    same += ((*a)[i] - (*b)[i]) * ((*a)[i] - (*b)[i]);
    opposite += ((*a)[i] + (*b)[i]) * ((*a)[i] + (*b)[i]);
  }
  // By the distance of the nearer two: exact for small angles, as an arc cosine is not.
  return 4 * std::asin(std::min(1.0, std::sqrt(std::min(same, opposite)) / 2));
}

/// Walks a pattern and a value together.
class Matcher {
 public:
  explicit Matcher(Captures& captures) : captures_(captures) {}

  std::optional<std::string> match(const Json& pattern, const Json& value,
                                   const std::string& path) {
    if (is_name(pattern)) return match_name(pattern, value, path);
    if (is_test(pattern)) return match_tests(pattern, value, path);
    if (pattern.is_object()) return match_object(pattern, value, path);
    if (pattern.is_array()) return match_array(pattern, value, path);
    return pattern == value ? std::nullopt : fault(path, shown(pattern), value);
  }

 private:
  static std::optional<std::string> fault(const std::string& path, const std::string& expected,
                                          const Json& value) {
    return "at " + (path.empty() ? "the top" : path) + "\n  expected " + expected +
           "\n  came     " + shown(value);
  }

  std::optional<std::string> match_name(const Json& pattern, const Json& value,
                                        const std::string& path) {
    const auto name = pattern.get<std::string>();
    if (name == "$any") return {};
    const auto [known, is_new] = captures_.emplace(name, value);
    if (is_new || known->second == value) return {};
    return fault(path, name + " = " + shown(known->second), value);
  }

  std::optional<std::string> match_object(const Json& pattern, const Json& value,
                                          const std::string& path) {
    if (!value.is_object()) return fault(path, "an object", value);
    for (const auto& [key, member] : pattern.items()) {
      const std::string member_path = path + '/' + key;
      if (is_test(member) && member.contains("$absent")) {
        if (value.contains(key)) return fault(member_path, "no such member", value[key]);
        continue;
      }
      if (!value.contains(key)) return fault(path, "a member \"" + key + '"', value);
      if (auto reason = match(member, value[key], member_path)) return reason;
    }
    return {};
  }

  std::optional<std::string> match_array(const Json& pattern, const Json& value,
                                         const std::string& path) {
    if (!value.is_array() || value.size() != pattern.size()) {
      return fault(path, "a list of " + std::to_string(pattern.size()), value);
    }
    for (std::size_t i = 0; i < pattern.size(); ++i) {
      if (auto reason = match(pattern[i], value[i], path + '/' + std::to_string(i))) return reason;
    }
    return {};
  }

  std::optional<std::string> match_tests(const Json& pattern, const Json& value,
                                         const std::string& path) {
    for (const auto& [test, operand] : pattern.items()) {
      if (test == "$capture") continue;
      if (auto reason = match_test(test, operand, value, path)) return reason;
    }
    if (pattern.contains("$capture")) captures_[pattern["$capture"].get<std::string>()] = value;
    return {};
  }

  std::optional<std::string> match_test(const std::string& test, const Json& operand,
                                        const Json& value, const std::string& path) {
    if (test == "$has") return match_any_element(operand, value, path);
    if (test == "$each") return match_each_element(operand, value, path);
    if (holds(test, substitute(operand, captures_), value)) return {};
    return fault(path, shown(Json{{test, operand}}), value);
  }

  static bool holds(const std::string& test, const Json& operand, const Json& value) {
    if (test == "$eq") return value == operand;
    if (test == "$ne") return value != operand;
    if (test == "$type") return value.type_name() == operand.get<std::string>();
    if (test == "$size") {
      const bool sized = value.is_array() || value.is_string();
      const std::size_t size =
          value.is_string() ? value.get_ref<const std::string&>().size() : value.size();
      return sized && operand == size;
    }
    if (test == "$contains") {
      return value.is_string() && value.get_ref<const std::string&>().find(
                                      operand.get<std::string>()) != std::string::npos;
    }
    return holds_for_number(test, operand, value);
  }

  static bool holds_for_number(const std::string& test, const Json& operand, const Json& value) {
    if (test == "$near") {
      return is_near(value, operand.at(0), operand.at(1).get<double>());
    }
    if (test == "$turned") {
      return angle_between(value, operand.at(0)) <= operand.at(1).get<double>();
    }
    const bool known = test == "$ge" || test == "$gt" || test == "$le" || test == "$lt";
    if (!known) throw ScriptError("unknown test " + test);
    if (!value.is_number() || !operand.is_number()) return false;
    if (test == "$ge") return value >= operand;
    if (test == "$gt") return value > operand;
    if (test == "$le") return value <= operand;
    return value < operand;
  }

  std::optional<std::string> match_any_element(const Json& pattern, const Json& value,
                                               const std::string& path) {
    if (!value.is_array()) return fault(path, "a list", value);
    for (const Json& element : value) {
      const Captures before = captures_;
      if (!match(pattern, element, path)) return {};
      captures_ = before;
    }
    return fault(path, "an element " + shown(pattern), value);
  }

  std::optional<std::string> match_each_element(const Json& pattern, const Json& value,
                                                const std::string& path) {
    if (!value.is_array()) return fault(path, "a list", value);
    for (std::size_t i = 0; i < value.size(); ++i) {
      if (auto reason = match(pattern, value[i], path + '/' + std::to_string(i))) return reason;
    }
    return {};
  }

  Captures& captures_;
};

}  // namespace

Json substitute(const Json& value, const Captures& captures) {
  if (is_name(value)) {
    const auto found = captures.find(value.get<std::string>());
    if (found == captures.end()) throw ScriptError("no capture " + value.get<std::string>());
    return found->second;
  }
  if (const Json* terms = operands(value, "$add")) {
    return sum(substitute((*terms)[0], captures), substitute((*terms)[1], captures));
  }
  if (const Json* parts = operands(value, "$repeat")) {
    return repeated((*parts)[0], substitute((*parts)[1], captures));
  }
  if (is_test(value) && value.contains("$join")) return joined(value["$join"], captures);
  Json result = value;
  if (value.is_structured()) {
    for (Json& element : result) element = substitute(element, captures);
  }
  return result;
}

std::optional<std::string> mismatch(const Json& pattern, const Json& value, Captures& captures) {
  Captures found = captures;
  auto reason = Matcher(found).match(pattern, value, "");
  if (!reason) captures = std::move(found);
  return reason;
}

}  // namespace vat::script
