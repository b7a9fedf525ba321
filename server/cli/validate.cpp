#include <CLI/CLI.hpp>
#include <iomanip>
#include <iostream>
#include <memory>
#include <string>

#include "core/numerics/cost_estimate.h"
#include "core/simulation/simulation.h"
#include "server/cli/common/command.h"
#include "server/cli/common/commands.h"
#include "server/cli/common/data_folders.h"
#include "server/cli/common/scene_argument.h"

namespace vat {

namespace {

struct ValidateOptions {
  std::string scene;
  std::string scenes_folder = installed_scenes_folder();
};

/// In round numbers, for it is an estimate.
void print_cost(const Scene& scene) {
  const std::vector<SampledBody> bodies = sample_bodies(scene);
  const CostEstimate cost = estimate_cost(scene, pointers_to(bodies));
  std::cout << std::setprecision(2) << "about " << cost.memory / 1e6 << " MB, and " << cost.seconds
            << " s of one core for a simulated second, without contacts\n";
}

void print_summary(const std::string& argument, const Simulation& simulation) {
  const Numerics& numerics = simulation.scene().numerics;
  std::cout << argument << ": valid; bodies: " << simulation.bodies().size()
            << ", particles: " << simulation.particle_count()
            << ", springs: " << simulation.spring_count()
            << ", steps per tick: " << simulation.steps_per_tick() << " of "
            << simulation.step_size() << " s (" << to_string(numerics.integrator) << ")\n";
  print_cost(simulation.scene());
}

int validate(const ValidateOptions& options) {
  const Result<Scene> scene = load_scene(options.scene, options.scenes_folder);
  if (!scene) return fail(options.scene, scene.errors());
  const Result<Simulation> simulation = Simulation::create(scene.value());
  if (!simulation) return fail(options.scene, simulation.errors());
  print_warnings(options.scene, scene.value());
  print_summary(options.scene, simulation.value());
  return kExitOk;
}

}  // namespace

void add_validate_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "validate", "Check a scene; print every error and warning with its JSON pointer");
  const auto options = std::make_shared<ValidateOptions>();
  command->add_option("scene", options->scene, kSceneHelp)->required();
  command->add_option("--scenes", options->scenes_folder, "Folder of the catalogue");
  command->footer("Exit codes: 0 valid (warnings allowed), 1 invalid, 2 wrong usage.");
  command->callback([options, &exit_code] { exit_code = validate(*options); });
}

}  // namespace vat
