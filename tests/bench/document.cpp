#include "tests/bench/document.h"

#include <CLI/CLI.hpp>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <memory>

#include "server/cli/command.h"
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

/// FOLDER/COMMAND/NAME.json, as the command of that name writes it.
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

/// What each marker of the page stands for.
Result<std::map<std::string, std::string>> make_contents(const fs::path& folder) {
  const Result<Json> validation = read_document_rows(folder, "validate", "validation");
  if (!validation) return validation.errors();
  const Result<Json> cheapest = read_document_rows(folder, "accuracy", "cheapest");
  if (!cheapest) return cheapest.errors();
  const Result<Json> control = read_document_rows(folder, "accuracy", "control");
  if (!control) return control.errors();
  const Result<Json> solvers = read_document_rows(folder, "accuracy", "solvers");
  if (!solvers) return solvers.errors();
  const Result<Json> laws = read_document_rows(folder, "accuracy", "laws");
  if (!laws) return laws.errors();
  const Result<Json> stability = read_document_rows(folder, "stability", "stability");
  if (!stability) return stability.errors();
  try {
    return std::map<std::string, std::string>{
        {"cases", to_markdown(cases_table(validation.value(), case_titles()))},
        {"limits", to_markdown(limits_table(validation.value()))},
        {"methods", to_markdown(methods_table(cheapest.value()))},
        {"solvers", to_markdown(solvers_table(solvers.value()))},
        {"laws", to_markdown(laws_table(laws.value()))},
        {"steps", to_markdown(steps_table(control.value()))},
        {"counts", to_markdown(counts_table(stability.value()))}};
  } catch (const std::exception& error) {
    return Error{"bad_table", folder.string(), error.what()};
  }
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

Status write_document(const fs::path& results, const fs::path& page) {
  const Result<std::string> text = read_text(page);
  if (!text) return text.errors();
  const Result<std::map<std::string, std::string>> contents = make_contents(results);
  if (!contents) return contents.errors();
  const Result<std::string> filled = fill_markers(text.value(), contents.value());
  if (!filled) return filled.errors();
  for (const std::string& picture : pictures_of(text.value())) {
    if (Status copied = copy_picture(results, page.parent_path() / picture); !copied) return copied;
  }
  return write_text(page, filled.value());
}

void add_document_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "document", "Fill tables and pictures of core/ACCURACY.md from the other commands' results");
  const auto results = std::make_shared<std::string>(VAT_SOURCE_DIR "/build/bench");
  const auto page = std::make_shared<std::string>(VAT_SOURCE_DIR "/core/ACCURACY.md");
  command->add_option("--results", *results, "Folder of the results")->capture_default_str();
  command->add_option("--page", *page, "The page")->capture_default_str();
  command->footer(
      "Exit codes: 0 fine, 1 a result is missing or the page does not fit, 2 wrong usage.");
  command->callback([results, page, &exit_code] {
    const Status written = write_document(*results, *page);
    exit_code = written ? kExitOk : fail("document", written.errors());
    if (written) std::cout << "written to " << *page << '\n';
  });
}

}  // namespace vat::bench
