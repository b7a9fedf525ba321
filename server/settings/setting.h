#pragma once

#include <chrono>
#include <concepts>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/json/json_reader.h"

namespace vat {

/// One setting of the server: its names, what it may be, and the way to its value, which lives
/// elsewhere. `name` is that of its member in a configuration file, such as "max_connections".
struct Setting {
  std::string name;
  std::string group;  ///< heading in the help
  std::string help;
  std::string range;  ///< what it may be, such as "1 to 64" or "ADDRESS"
  bool is_number = false;
  std::string shown_default;  ///< where the value itself says nothing; else empty
  /// What a value must be, where it is not; else empty.
  std::function<std::string(const Json&)> find_fault;
  std::function<void(const Json&)> assign;  ///< a value without a fault
  std::function<Json()> value;
};

/// "--max-connections".
std::string option_of(const Setting& setting);
/// "VAT_MAX_CONNECTIONS".
std::string variable_of(const Setting& setting);
/// The value as a member of a configuration file, from the text of an option or a variable. What
/// is not a number where one must be stays text, which find_fault() then refuses.
Json to_json(const Setting& setting, const std::string& text);
/// The value as the text of an option.
std::string to_text(const Json& value);

/// What is wrong with a text; empty: nothing.
using TextCheck = std::function<std::string(const std::string&)>;

/// A text that the check allows; `what` stands for it in the help: "ADDRESS".
Setting text_setting(std::string name, std::string& target, std::string what, std::string help,
                     TextCheck check = {});
/// One of some words.
Setting word_setting(std::string name, std::string& target, std::vector<std::string> words,
                     std::string help);
Setting whole_setting(std::string name, std::uint64_t min, std::uint64_t max, std::string help,
                      std::function<void(std::uint64_t)> assign,
                      std::function<std::uint64_t()> value);
/// A number with a fraction.
Setting real_setting(std::string name, double min, double max, std::string help,
                     std::function<void(double)> assign, std::function<double()> value);

template <std::unsigned_integral Whole>
Setting number_setting(std::string name, Whole& target, Whole min, Whole max, std::string help) {
  return whole_setting(
      std::move(name), min, max, std::move(help),
      [&target](std::uint64_t value) { target = static_cast<Whole>(value); },
      [&target]() -> std::uint64_t { return target; });
}
inline Setting number_setting(std::string name, double& target, double min, double max,
                              std::string help) {
  return real_setting(
      std::move(name), min, max, std::move(help), [&target](double value) { target = value; },
      [&target] { return target; });
}

/// Times in seconds; the second kind may have a fraction.
Setting time_setting(std::string name, std::chrono::seconds& target, std::uint64_t min,
                     std::uint64_t max, std::string help);
Setting time_setting(std::string name, std::chrono::milliseconds& target, double min, double max,
                     std::string help);

}  // namespace vat
