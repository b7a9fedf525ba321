// vat backup, vat restore

#include "server/storage/backup.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <string>

#include "server/cli/common/command.h"
#include "server/cli/common/commands.h"
#include "server/storage/sqlite/storage_error.h"

namespace vat {
namespace {

struct BackupOptions {
  std::string file;
  std::string data;
};

template <class Work>
int run(const Work& work) {
  try {
    work();
    return kExitOk;
  } catch (const StorageError& error) {
    std::cerr << "vat: " << error.what() << '\n';
    return kExitFailed;
  }
}

std::shared_ptr<BackupOptions> add_options(CLI::App& command, const char* file_help) {
  auto options = std::make_shared<BackupOptions>();
  command.add_option("file", options->file, file_help)->required();
  command.add_option("--data", options->data, "Data folder of the server; default: VAT_DATA")
      ->envname("VAT_DATA")
      ->required();
  command.footer("Exit codes: 0 success, 1 failure, 2 wrong usage.");
  return options;
}

}  // namespace

void add_backup_commands(CLI::App& app, int& exit_code) {
  CLI::App* backup = app.add_subcommand(
      "backup", "Copy the data folder of a server, which may be running, to one file");
  const auto from = add_options(*backup, "File to create");
  backup->callback(
      [from, &exit_code] { exit_code = run([&] { write_backup(from->data, from->file); }); });
  CLI::App* restore =
      app.add_subcommand("restore", "Create the data folder of a server from a backup");
  const auto to = add_options(*restore, "File of vat backup");
  restore->callback(
      [to, &exit_code] { exit_code = run([&] { restore_backup(to->file, to->data); }); });
}

}  // namespace vat
