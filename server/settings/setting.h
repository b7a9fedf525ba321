#pragma once

#include <chrono>
#include <concepts>
#include <functional>
#include <string>
#include <vector>

#include "protocol/json/json_reader.h"

namespace vat {

/// Setting of the server: names, range, and access to the value. `name` is the member in a
/// configuration file, such as "max_connections".
struct Setting {
  std::string name;
  std::string group;  ///< heading in the help text
  std::string help;
  std::string range;  ///< allowed values, such as "1 to 64" or "ADDRESS"
  bool is_number = false;
  bool is_list = false;  ///< list of texts separated by commas; the option can be repeated
  /// Default value in the help text, if the value itself is not shown; otherwise empty.
  std::string shown_default;
  /// Returns a description of the allowed values if the value is invalid. Otherwise returns an
  /// empty text.
  std::function<std::string(const Json&)> find_fault;
  std::function<void(const Json&)> assign;  ///< sets a valid value
  std::function<Json()> value;
};

/// Returns the name of the option, such as "--max-connections".
std::string option_of(const Setting& setting);
/// Returns the name of the environment variable, such as "VAT_MAX_CONNECTIONS".
std::string variable_of(const Setting& setting);
/// Returns the value of an option or environment variable in the form of a configuration file. An
/// invalid number remains text, which find_fault() rejects.
Json to_json(const Setting& setting, const std::string& text);
/// Returns the value in the text form of an option.
std::string to_text(const Json& value);

/// Function that returns a description of the fault of a text, or an empty text.
using TextCheck = std::function<std::string(const std::string&)>;

/// Returns a setting for a text that passes the check. `what` is the description in the help, such
/// as "ADDRESS".
Setting text_setting(std::string name, std::string& target, std::string what, std::string help,
                     TextCheck check = {});
/// Returns a setting for a list of texts separated by commas. Each text must pass the check.
Setting list_setting(std::string name, std::vector<std::string>& target, std::string what,
                     std::string help, TextCheck check);
/// Returns a setting for one of several words.
Setting word_setting(std::string name, std::string& target, std::vector<std::string> words,
                     std::string help);
Setting whole_setting(std::string name, std::uint64_t min, std::uint64_t max, std::string help,
                      std::function<void(std::uint64_t)> assign,
                      std::function<std::uint64_t()> value);
/// Returns a setting for a real number.
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

/// Return a setting for a time [s]. The second function accepts fractions.
Setting time_setting(std::string name, std::chrono::seconds& target, std::uint64_t min,
                     std::uint64_t max, std::string help);
Setting time_setting(std::string name, std::chrono::milliseconds& target, double min, double max,
                     std::string help);

}  // namespace vat
