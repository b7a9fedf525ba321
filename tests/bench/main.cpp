#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>

#include "server/cli/command.h"
#include "tests/bench/accuracy.h"
#include "tests/bench/codec.h"
#include "tests/bench/compare.h"
#include "tests/bench/document.h"
#include "tests/bench/fanout.h"
#include "tests/bench/instructions.h"
#include "tests/bench/seeks.h"
#include "tests/bench/soak.h"
#include "tests/bench/speed.h"
#include "tests/bench/stability.h"
#include "tests/bench/validate.h"

namespace {

int run(int argc, char** argv) {
  CLI::App app{"Speed, validation, accuracy and stability of the simulation, and many viewers",
               "vat bench"};
  // Not require_subcommand(1): that would hide which word is not a sub-command.
  app.require_subcommand(0, 1);
  app.callback([&app] {
    if (app.get_subcommands().empty()) throw CLI::RequiredError("A subcommand");
  });
  int exit_code = vat::kExitOk;
  vat::bench::add_speed_command(app, exit_code);
  vat::bench::add_compare_command(app, exit_code);
  vat::bench::add_instructions_command(app, exit_code);
  vat::bench::add_validate_command(app, exit_code);
  vat::bench::add_accuracy_command(app, exit_code);
  vat::bench::add_stability_command(app, exit_code);
  vat::bench::add_codec_command(app, exit_code);
  vat::bench::add_fanout_command(app, exit_code);
  vat::bench::add_seeks_command(app, exit_code);
  vat::bench::add_soak_command(app, exit_code);
  vat::bench::add_document_command(app, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? vat::kExitOk : vat::kExitUsage;
  }
  return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const int exit_code = run(argc, argv);
    if (std::cout.flush()) return exit_code;
    std::cerr << "vat bench: standard output cannot be written\n";  // a full disk, say
  } catch (const std::exception& error) {
    std::cerr << "vat bench: " << error.what() << '\n';
  }
  return vat::kExitFailed;
}
