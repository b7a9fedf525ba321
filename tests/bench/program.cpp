#include "tests/bench/program.h"

#include <CLI/CLI.hpp>

#include "server/cli/common/command.h"
#include "tests/bench/accuracy/accuracy.h"
#include "tests/bench/cluster/cluster.h"
#include "tests/bench/cluster/relay_messages.h"
#include "tests/bench/cluster/relays.h"
#include "tests/bench/cluster/scale.h"
#include "tests/bench/codec/codec.h"
#include "tests/bench/compare.h"
#include "tests/bench/document/document.h"
#include "tests/bench/durability/durability.h"
#include "tests/bench/durability/recovery.h"
#include "tests/bench/fanout/fanout.h"
#include "tests/bench/faults/faults.h"
#include "tests/bench/instructions/instructions.h"
#include "tests/bench/kernels/kernels.h"
#include "tests/bench/output/output.h"
#include "tests/bench/race/race.h"
#include "tests/bench/rounding/rounding.h"
#include "tests/bench/seeks.h"
#include "tests/bench/soak/soak.h"
#include "tests/bench/speed/speed.h"
#include "tests/bench/stability/stability.h"
#include "tests/bench/tune/tune.h"
#include "tests/bench/validate/validate.h"

namespace vat::bench {

int run_command(int argc, char** argv) {
  CLI::App app{"Speed, validation, accuracy and stability of the simulation, and many viewers",
               "vat bench"};
  // require_subcommand(1) would not report which word is not a sub-command.
  app.require_subcommand(0, 1);
  app.callback([&app] {
    if (app.get_subcommands().empty()) throw CLI::RequiredError("A subcommand");
  });
  int exit_code = kExitOk;
  add_speed_command(app, exit_code);
  add_compare_command(app, exit_code);
  add_instructions_command(app, exit_code);
  add_kernels_command(app, exit_code);
  add_validate_command(app, exit_code);
  add_rounding_command(app, exit_code);
  add_accuracy_command(app, exit_code);
  add_stability_command(app, exit_code);
  add_tune_bench_command(app, exit_code);
  add_codec_command(app, exit_code);
  add_fanout_command(app, exit_code);
  add_seeks_command(app, exit_code);
  add_soak_command(app, exit_code);
  add_faults_command(app, exit_code);
  add_durability_command(app, exit_code);
  add_recovery_command(app, exit_code);
  add_cluster_command(app, exit_code);
  add_relays_command(app, exit_code);
  add_relay_messages_command(app, exit_code);
  add_scale_command(app, exit_code);
  add_output_command(app, exit_code);
  add_race_command(app, exit_code);
  add_document_command(app, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kExitOk : kExitUsage;
  }
  return exit_code;
}

}  // namespace vat::bench
