#include "server/session/core/scene_loading.h"

#include <algorithm>
#include <utility>

#include "core/device/device_use.h"
#include "core/saved/greatest_size.h"
#include "core/support/check.h"
#include "core/support/nearest_name.h"
#include "server/operations/choose_device.h"
#include "server/operations/memory_limit.h"
#include "server/storage/saved/saved_scenes.h"

namespace vat {
namespace {

RpcError scene_refused(Errors errors) {
  for (Error& error : errors) error.path.insert(0, "/scene");
  return invalid_params(errors);
}

}  // namespace

Result<std::string> refuse_mesh_file(const std::string&) {
  return Error{"not_allowed", "",
               "a mesh in a message must contain vertices and triangles, not the name of a file"};
}

RpcError unknown_scene(std::string_view name, const Catalogue& catalogue) {
  NearestName nearest(name);
  nearest.consider_all(catalogue.entries(), &CatalogueEntry::name);
  return with_suggestion(no_such_scene(name), nearest.suggestion());
}

std::variant<Scene, RpcError> read_client_scene(const Json& value, const Catalogue& catalogue,
                                                Level level) {
  const bool is_named = value.is_string();
  const Scene* named = nullptr;
  if (is_named) {
    const auto& name = value.get_ref<const std::string&>();
    named = catalogue.find(name);
    if (named == nullptr) return unknown_scene(name, catalogue);
  }
  Result<Scene> scene = is_named ? Result<Scene>(*named) : read_scene(value, refuse_mesh_file);
  if (scene) scene = at_level(std::move(scene).value(), level);
  if (!scene) return scene_refused(scene.errors());
  return std::move(scene).value();
}

Level read_level(ObjectReader& params) {
  return static_cast<Level>(
      params.choice("level", kNamesOf<Level>, static_cast<std::size_t>(Level::normal)));
}

std::variant<Json, RpcError> find_saved_scene(const std::string& name,
                                              const SessionEnvironment& environment) {
  const auto saved = environment.scenes == nullptr ? std::nullopt : environment.scenes->find(name);
  if (!saved) return unknown_scene(name, environment.catalogue);
  const std::string& text = saved->scene;
  Result<Json> json = parse_json(text, {text.size(), kMaxMessageDepth, text.size() + 1});
  if (!json) throw StorageError(StorageError::Kind::corrupt, "the saved scene " + name);
  return std::move(json).value();
}

std::variant<Scene, RpcError> read_named_scene(const Json& value, Level level,
                                               const SessionEnvironment& environment) {
  if (!value.is_string() || environment.catalogue.find(value.get_ref<const std::string&>())) {
    return read_client_scene(value, environment.catalogue, level);
  }
  auto saved = find_saved_scene(value.get_ref<const std::string&>(), environment);
  if (auto* error = std::get_if<RpcError>(&saved)) return std::move(*error);
  return read_client_scene(std::get<Json>(saved), environment.catalogue, level);
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

std::size_t max_state_bytes(const ServerLimits& limits) {
  constexpr std::size_t kMost = std::size_t{1} << 30;  // as of a checkpoint
  return std::min(kMost, greatest_saved_size(limits.max_particles, limits.max_springs));
}

Resources resources_of(const Simulation& simulation) {
  return {simulation.greatest_particle_count(), simulation.spring_count()};
}

std::variant<Simulation, RpcError> make_simulation(const Scene& scene,
                                                   const SessionEnvironment& environment,
                                                   InstructionSet instructions) {
  Result<Simulation> simulation = Simulation::create(scene, &environment.runner, instructions);
  if (!simulation) return scene_refused(simulation.errors());
  if (auto excess = find_excess(simulation.value(), environment.limits)) return *std::move(excess);
  if (environment.memory != nullptr) {  // again, because the new simulation may be large
    if (const auto excess = environment.memory->find_excess()) return limit_reached(*excess);
  }
  return std::move(simulation).value();
}

std::variant<Scene, RpcError> with_device(Scene scene, const SessionEnvironment& environment) {
  DeviceChoice device = device_for(environment.device, scene);
  if (device.is_auto) {
    auto simulation = make_simulation(scene, environment, environment.instructions);
    if (auto* error = std::get_if<RpcError>(&simulation)) return std::move(*error);
    device = choose_device(device, std::get<Simulation>(simulation), environment.runner);
  }
  scene.numerics.device.reset();
  if (!device.is_cpu) scene.numerics.device = device;
  return scene;
}

std::variant<Json, RpcError> with_device(Json params, const SessionEnvironment& environment) {
  const Json::json_pointer place("/scene/numerics/device");
  if (!environment.device && !params.contains(place)) return params;
  const std::optional<Level> level = find_level(params.value("level", to_string(Level::normal)));
  VAT_CHECK(level.has_value());
  auto read = read_client_scene(params.at("scene"), environment.catalogue, *level);
  if (auto* error = std::get_if<RpcError>(&read)) return std::move(*error);
  auto scene = with_device(std::get<Scene>(std::move(read)), environment);
  if (auto* error = std::get_if<RpcError>(&scene)) return std::move(*error);
  if (const auto& device = std::get<Scene>(scene).numerics.device) {
    params[place] = to_text(*device);
  } else if (params.contains(place)) {
    params["scene"]["numerics"].erase("device");
  }
  return params;
}

DeviceChoice device_of(const Scene& scene, const SessionEnvironment& environment) {
  const DeviceChoice device = scene.numerics.device.value_or(DeviceChoice{});
  // Only a scene of a foreign recording can have an automatic device.
  return device.is_auto || environment.device == DeviceChoice{} ? DeviceChoice{} : device;
}

std::variant<Simulation, RpcError> make_on_device(const Scene& scene,
                                                  const SessionEnvironment& environment,
                                                  InstructionSet instructions) {
  auto made = make_simulation(scene, environment, instructions);
  auto* const simulation = std::get_if<Simulation>(&made);
  if (simulation == nullptr) return made;
  const Status used = use_device(device_of(scene, environment), *simulation);
  if (!used) return scene_refused(used.errors());
  return made;
}

}  // namespace vat
