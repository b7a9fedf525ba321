#include "tests/bench/document/document.h"

#include <CLI/CLI.hpp>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "server/cli/common/command.h"
#include "tests/bench/document/markers.h"
#include "tests/bench/document/page_tables.h"
#include "tests/validation/cases.h"

namespace vat::bench {

namespace {

namespace fs = std::filesystem;

Result<std::string> read_text(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (!stream) return Error{"system", file.string(), "cannot be read"};
  return text;
}

/// Reads FOLDER/COMMAND/NAME.json, the result of the command with this name.
Result<Json> read_document_rows(const fs::path& folder, const std::string& command,
                                const std::string& name) {
  const fs::path file = folder / command / (name + ".json");
  const Result<std::string> text = read_text(file);
  if (!text) {
    return Error{"system", file.string(), "cannot be read; ./vat bench " + command + " writes it"};
  }
  Json rows = Json::parse(text.value(), nullptr, false);
  if (!rows.is_array()) return Error{"parse_error", file.string(), "is no table"};
  return rows;
}

std::map<std::string, std::string> case_titles() {
  std::map<std::string, std::string> titles;
  for (const validation::Case& one : validation::all_cases()) titles[one.name] = one.title;
  return titles;
}

/// The content of a marker: a table from the results of a command.
struct Content {
  const char* marker;
  const char* command;
  const char* name;  ///< name of the result
  Table (*make)(const Json& rows);
};

constexpr Content kContents[] = {
    {"cases", "validate", "validation",
     [](const Json& rows) { return cases_table(rows, case_titles()); }},
    {"summary", "validate", "validation",
     [](const Json& rows) { return summary_table(rows, case_titles()); }},
    {"limits", "validate", "validation", limits_table},
    {"methods", "accuracy", "cheapest", methods_table},
    {"solvers", "accuracy", "solvers", solvers_table},
    {"tolerances", "accuracy", "tolerances", tolerances_table},
    {"accuracies", "accuracy", "accuracies", accuracies_rows_table},
    {"growth", "accuracy", "growth", growth_rows_table},
    {"catalogue", "accuracy", "catalogue", catalogue_rows_table},
    {"laws", "accuracy", "laws", laws_table},
    {"steps", "accuracy", "control", steps_table},
    {"counts", "stability", "stability", counts_table},
    {"devices", "speed", "speed", devices_table},
    {"device-cases", "validate", "device", device_cases_table},
    {"kernels", "kernels", "kernels", kernels_table},
    {"times", "kernels", "times", times_table},
    {"rounding", "rounding", "rounding", rounding_table},
    {"race", "race", "race", race_table},
    {"durability", "durability", "durability", durability_table},
    {"recovery", "recovery", "recovery", recovery_table},
    {"faults", "faults", "faults", faults_table}};

/// Returns the contents of the markers that the page has.
Result<std::map<std::string, std::string>> make_contents(const std::string& page,
                                                         const fs::path& folder) {
  std::map<std::string, std::string> contents;
  for (const Content& content : kContents) {
    if (!has_marker(page, content.marker)) continue;
    const Result<Json> rows = read_document_rows(folder, content.command, content.name);
    if (!rows) return rows.errors();
    try {
      contents[content.marker] = to_markdown(content.make(rows.value()));
    } catch (const std::exception& error) {
      return Error{"bad_table", content.name, error.what()};
    }
  }
  return contents;
}

Status copy_picture(const fs::path& results, const fs::path& target) {
  for (const char* command : {"accuracy", "stability"}) {
    const fs::path source = results / command / target.filename();
    if (!fs::exists(source)) continue;
    std::error_code error;
    fs::create_directories(target.parent_path(), error);
    if (!error) {
      fs::copy_file(source, target, fs::copy_options::overwrite_existing, error);
    }
    if (error) return Error{"system", target.string(), error.message()};
    return {};
  }
  return Error{"system", target.string(), "there is no such picture in " + results.string()};
}

}  // namespace

std::vector<std::string> document_markers() {
  std::vector<std::string> markers;
  for (const Content& content : kContents) markers.emplace_back(content.marker);
  return markers;
}

Status write_document(const fs::path& results, const fs::path& page) {
  const Result<std::string> text = read_text(page);
  if (!text) return text.errors();
  const Result<std::map<std::string, std::string>> contents = make_contents(text.value(), results);
  if (!contents) return contents.errors();
  const Result<std::string> filled = fill_markers(text.value(), contents.value());
  if (!filled) return filled.errors();
  for (const std::string& picture : pictures_of(text.value())) {
    if (!picture.ends_with(".svg")) continue;  // not a result
    if (Status copied = copy_picture(results, page.parent_path() / picture); !copied) return copied;
  }
  return write_text(page, filled.value());
}

void add_document_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("document",
                                         "Fill tables and pictures of core/ACCURACY.md and "
                                         "README.md and server/RELIABILITY.md from the other "
                                         "commands' results");
  const auto results = std::make_shared<std::string>(VAT_SOURCE_DIR "/build/bench");
  const auto pages = std::make_shared<std::vector<std::string>>(
      std::vector<std::string>{VAT_SOURCE_DIR "/core/ACCURACY.md", VAT_SOURCE_DIR "/README.md",
                               VAT_SOURCE_DIR "/server/RELIABILITY.md"});
  command->add_option("--results", *results, "Folder of the results")->capture_default_str();
  command->add_option("--page", *pages, "A page; may be given again")->take_all()->expected(1);
  command->footer(
      "Exit codes: 0 success, 1 a result is missing or the page does not fit, 2 wrong usage.");
  command->callback([results, pages, &exit_code] {
    for (const std::string& page : *pages) {
      const Status written = write_document(*results, page);
      exit_code = written ? kExitOk : fail("document", written.errors());
      if (!written) return;
      std::cout << "written to " << page << '\n';
    }
  });
}

}  // namespace vat::bench
