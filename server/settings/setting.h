#pragma once

#include <chrono>
#include <concepts>
#include <functional>
#include <string>
#include <vector>

#include "protocol/json/json_reader.h"

namespace vat {

/// A setting of the server: names, range, and access to its value. `name` is its member in a
/// configuration file, such as "max_connections".
struct Setting {
  std::string name;
  std::string group;  ///< heading in the help
  std::string help;
  std::string range;  ///< allowed values, such as "1 to 64" or "ADDRESS"
  bool is_number = false;
  std::string
      shown_default;  ///< default for the help, if the value itself is not shown; else empty
  /// Returns a description of the allowed values if the value is invalid, or an empty text.
  std::function<std::string(const Json&)> find_fault;
  std::function<void(const Json&)> assign;  ///< sets a valid value
  std::function<Json()> value;
};

/// Returns for example "--max-connections".
std::string option_of(const Setting& setting);
/// Returns for example "VAT_MAX_CONNECTIONS".
std::string variable_of(const Setting& setting);
/// Returns the value of an option or variable as in a configuration file. An invalid number stays
/// text, which find_fault() refuses.
Json to_json(const Setting& setting, const std::string& text);
/// Returns the value as the text of an option.
std::string to_text(const Json& value);

/// Returns the fault of a text, or an empty text.
using TextCheck = std::function<std::string(const std::string&)>;

/// A text that passes the check. `what` describes it in the help: "ADDRESS".
Setting text_setting(std::string name, std::string& target, std::string what, std::string help,
                     TextCheck check = {});
/// One of several words.
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

/// Times in seconds. The second kind may have a fraction.
Setting time_setting(std::string name, std::chrono::seconds& target, std::uint64_t min,
                     std::uint64_t max, std::string help);
Setting time_setting(std::string name, std::chrono::milliseconds& target, double min, double max,
                     std::string help);

}  // namespace vat
