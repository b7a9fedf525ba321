#include "server/cli/common/option_checks.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/support/nearest_name.h"
#include "protocol/files/text.h"

namespace vat {

CLI::Validator real_in(double min, double max) {
  std::string range = "[";
  append_number(range, min);
  range += ", ";
  append_number(range, max);
  range += "]";
  const auto check = [min, max, range](const std::string& text) {
    double value = 0;
    const bool good = CLI::detail::lexical_cast(text, value) && value >= min && value <= max;
    return good ? std::string() : "'" + text + "' is not a number in " + range;
  };
  return CLI::Validator(check, "in " + range);
}

CLI::Validator csv_file_name() {
  const auto check = [](const std::string& name) {
    const bool good = std::filesystem::path(name).extension() == ".csv";
    return good ? std::string() : "'" + name + "' must end in .csv";
  };
  return CLI::Validator(check, "FILE");
}

CLI::Validator one_of(std::vector<std::string> names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  const auto check = [names = std::move(names), list](const std::string& text) {
    if (std::ranges::find(names, text) != names.end()) return std::string();
    return unknown_name({}, "", "'" + text + "' is not one of " + list, text, names,
                        std::identity())
        .message;
  };
  return CLI::Validator(check, "{" + list + "}");
}

void add_isa_option(CLI::App& command, InstructionSet& instructions) {
  const auto check = [](const std::string& name) {
    const Result<InstructionSet> set = parse_instruction_set(name);
    const Status usable = set ? check_available(set.value()) : Status(set.errors());
    return usable ? std::string() : usable.errors().front().message;
  };
  const auto keep = [&instructions](const std::string& name) {
    instructions = parse_instruction_set(name).value();
  };
  command
      .add_option_function<std::string>(
          "--isa", keep, "Instruction set: baseline, avx2 or avx512; default: the machine's best")
      ->check(CLI::Validator(check, "SET"));
}

void add_level_option(CLI::App& command, Level& level) {
  const auto keep = [&level](const std::string& name) { level = *find_level(name); };
  command
      .add_option_function<std::string>(
          "--level", keep,
          "Level of detail: the same physics with fewer or more particles; default: normal")
      ->check(one_of({kNamesOf<Level>.begin(), kNamesOf<Level>.end()}));
}

void add_device_option(CLI::App& command, std::optional<DeviceChoice>& device) {
  const auto check = [](const std::string& text) {
    const Result<DeviceChoice> choice = parse_device(text);
    return choice ? std::string() : choice.errors().front().message;
  };
  const auto keep = [&device](const std::string& text) { device = parse_device(text).value(); };
  command
      .add_option_function<std::string>(
          "--device", keep,
          "Device of the steps: " + std::string(kDeviceForm) + "; default: the scene's, or cpu")
      ->check(CLI::Validator(check, "DEVICE"));
}

}  // namespace vat
