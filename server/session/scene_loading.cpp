#include "server/session/scene_loading.h"

#include <utility>

namespace vat {
namespace {

RpcError scene_refused(Errors errors) {
  for (Error& error : errors) error.path.insert(0, "/scene");
  return invalid_params(errors);
}

}  // namespace

Result<std::string> refuse_mesh_file(const std::string&) {
  return Error{"not_allowed", "",
               "a mesh that is sent must hold its vertices and triangles, not name a file"};
}

std::variant<Scene, RpcError> read_client_scene(const Json& value, const Catalogue& catalogue) {
  if (value.is_string()) {
    const auto& name = value.get_ref<const std::string&>();
    const Scene* scene = catalogue.find(name);
    if (scene == nullptr) return no_such_scene(name);
    return *scene;
  }
  Result<Scene> scene = read_scene(value, refuse_mesh_file);
  if (!scene) return scene_refused(scene.errors());
  return std::move(scene).value();
}

std::optional<RpcError> find_excess(const Simulation& simulation, const ServerLimits& limits) {
  const std::size_t particles = simulation.greatest_particle_count();
  if (particles > limits.max_particles) return limit_reached("particles", limits.max_particles);
  if (simulation.spring_count() > limits.max_springs) {
    return limit_reached("springs", limits.max_springs);
  }
  if (particles * simulation.steps_per_tick() > limits.max_particle_steps_per_tick) {
    return limit_reached("particle_steps_per_tick", limits.max_particle_steps_per_tick);
  }
  return {};
}

Resources resources_of(const Simulation& simulation) {
  return {simulation.greatest_particle_count(), simulation.spring_count()};
}

RpcError limit_reached(const ResourceExcess& excess) {
  return limit_reached(excess.limit, excess.maximum);
}

std::variant<Simulation, RpcError> make_simulation(const Scene& scene,
                                                   const SessionEnvironment& environment,
                                                   InstructionSet instructions) {
  Result<Simulation> simulation = Simulation::create(scene, &environment.runner, instructions);
  if (!simulation) return scene_refused(simulation.errors());
  if (auto excess = find_excess(simulation.value(), environment.limits)) return *std::move(excess);
  return std::move(simulation).value();
}

}  // namespace vat
