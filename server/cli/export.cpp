#include <CLI/CLI.hpp>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <memory>
#include <string>
#include <system_error>

#include "protocol/recording/html_page.h"
#include "server/cli/common/command.h"
#include "server/cli/common/commands.h"
#include "server/cli/common/data_folders.h"

namespace vat {
namespace {

struct ExportOptions {
  std::string recording;
  std::string page;
  std::string web_folder = installed_web_folder();
};

std::string check_page_name(const std::string& name) {
  const bool good = std::filesystem::path(name).extension() == ".html";
  return good ? std::string() : "'" + name + "' must end in .html";
}

int export_page(const ExportOptions& options) {
  const Status written = write_html_page(options.recording, options.page, options.web_folder);
  if (!written) return fail(options.recording, written.errors());
  std::error_code failed;
  const std::uintmax_t bytes = std::filesystem::file_size(options.page, failed);
  if (!failed) {
    std::cerr << options.page << ": " << std::fixed << std::setprecision(1)
              << static_cast<double>(bytes) / 1e6 << " MB\n";
  }
  return kExitOk;
}

}  // namespace

void add_export_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("export", "Write a recording of frames as a page");
  const auto options = std::make_shared<ExportOptions>();
  command->add_option("recording", options->recording, "Recording of vat record, in .vatrec")
      ->required()
      ->check(CLI::ExistingFile);
  command
      ->add_option("--html", options->page,
                   "File for the page, which contains the viewer and the recording")
      ->required()
      ->check(CLI::Validator(check_page_name, "FILE"));
  command->add_option("--web", options->web_folder, "Folder of the built viewer");
  command->footer(
      "The page opens from a disk and from any web server. Exit codes: 0 success, 1 not a "
      "recording "
      "of frames, or a failure, 2 wrong usage.");
  command->callback([options, &exit_code] { exit_code = export_page(*options); });
}

}  // namespace vat
