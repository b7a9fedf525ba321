#include "server/cli/common/program.h"

#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>
#include <string>

#include "core/support/nearest_name.h"
#include "server/cli/common/command.h"
#include "server/cli/common/version.h"

namespace vat {
namespace {

/// Returns the sub-command or option that the first unexpected argument can mean.
std::string suggest(const CLI::App& app) {
  const auto chosen = app.get_subcommands();
  const CLI::App& command = chosen.empty() ? app : *chosen.front();
  const std::string extra = app.remaining(true).front();
  NearestName nearest(extra.substr(0, extra.find('=')));
  if (chosen.empty()) {
    for (const CLI::App* each : app.get_subcommands({})) nearest.consider(each->get_name());
  }
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) nearest.consider("--" + name);
  }
  return nearest.suggestion();
}

int parse_and_run(int argc, char** argv, std::span<const AddCommand> commands) {
  CLI::App app{"Particle simulation of interacting liquids, deformable and rigid bodies", "vat"};
  app.set_version_flag("--version", version_text());
  // Not require_subcommand(1): that would hide which word is not a sub-command.
  app.require_subcommand(0, 1);
  app.callback([&app] {
    if (app.get_subcommands().empty()) throw CLI::RequiredError("A subcommand");
  });
  int exit_code = kExitOk;
  for (const AddCommand add : commands) add(app, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ExtrasError& error) {
    app.exit(error);
    if (const std::string name = suggest(app); !name.empty()) {
      std::cerr << "Did you mean " << name << "?\n";
    }
    return kExitUsage;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kExitOk : kExitUsage;
  }
  return exit_code;
}

}  // namespace

int run_program(int argc, char** argv, std::span<const AddCommand> commands) {
  try {
    const int exit_code = parse_and_run(argc, argv, commands);
    if (std::cout.flush()) return exit_code;
    std::cerr << "vat: standard output cannot be written\n";  // a full disk, say
  } catch (const std::exception& error) {
    std::cerr << "vat: " << error.what() << '\n';
  }
  return kExitFailed;
}

}  // namespace vat
