#include "tests/bench/options.h"

#include <algorithm>
#include <iostream>

namespace vat::bench {

namespace {

constexpr std::size_t kMaxThreads = 256;

}  // namespace

CLI::Validator thread_count_range() {
  return CLI::Range(std::size_t{1}, kMaxThreads);
}

void add_case_options(CLI::App& command, Options& options) {
  options.output = VAT_SOURCE_DIR "/build/bench/" + command.get_name();
  command.add_option("--output", options.output, "Folder for the results")->capture_default_str();
  command.add_flag("--quick", options.quick, "Fewer and shorter runs");
  command.add_option("--case", options.cases, "Only this case; may be given again")
      ->take_all()
      ->expected(1);
  command.add_flag("--list", options.list, "Print the names of the cases and exit");
}

void add_options(CLI::App& command, Options& options) {
  add_case_options(command, options);
  command.add_option("--threads", options.threads, "Threads of each simulation")
      ->check(thread_count_range())
      ->capture_default_str();
}

Result<std::vector<std::size_t>> choose(const std::vector<std::string>& wanted,
                                        const std::vector<std::string>& known) {
  std::vector<std::size_t> chosen;
  Errors errors;
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (wanted.empty() || std::ranges::find(wanted, known[i]) != wanted.end()) chosen.push_back(i);
  }
  for (const std::string& name : wanted) {
    if (std::ranges::find(known, name) != known.end()) continue;
    std::string message = "there is no such case; there are";
    for (const std::string& other : known) message += ' ' + other;
    errors.push_back({"unknown_name", name, message});
  }
  if (!errors.empty()) return errors;
  return chosen;
}

void print_names(const std::vector<std::string>& names) {
  for (const std::string& name : names) std::cout << name << '\n';
}

}  // namespace vat::bench
