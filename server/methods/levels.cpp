// scene.levels

#include <algorithm>
#include <cmath>
#include <variant>

#include "core/limits.h"
#include "core/numerics/choose_numerics.h"
#include "core/sampling/nozzle.h"
#include "core/validation/validate.h"
#include "server/methods/handlers.h"
#include "server/operations/scene_speed.h"
#include "server/session/core/scene_loading.h"

namespace vat {
namespace {

/// The least real-time factor of an offered level.
constexpr Real kMargin = 1.25;

std::size_t count_particles(const Scene& scene) {
  std::size_t count = 0;
  const std::vector<SampledBody> samples = sample_bodies(scene);
  for (std::size_t b = 0; b < samples.size(); ++b) {
    count += std::max(samples[b].positions.size(), most_particles(scene, scene.bodies[b]));
  }
  return count;
}

/// Returns whether the server accepts so many particles of a scene.
bool is_allowed(const Scene& scene, std::size_t particles, const ServerLimits& limits) {
  const auto steps =
      static_cast<std::size_t>(std::lround(scene.numerics.tick / scene.numerics.step));
  return particles <= limits.max_particles &&
         particles * steps <= limits.max_particle_steps_per_tick;
}

/// The levels of a scene that the server accepts.
struct Levels {
  std::vector<Level> levels;
  std::vector<Scene> scenes;
  std::vector<std::size_t> particles;
};

Levels accepted_levels(const Scene& normal, const ServerLimits& limits) {
  Levels accepted;
  for (std::size_t index = 0; index < kLevelCount; ++index) {
    const auto level = static_cast<Level>(index);
    Result<Scene> scaled = at_level(normal, level);
    if (!scaled || !find_errors(scaled.value()).empty()) continue;
    Scene& scene = scaled.value();
    resolve_accuracy(scene);
    const std::size_t particles = count_particles(scene);
    if (!is_allowed(scene, particles, limits)) continue;
    accepted.levels.push_back(level);
    accepted.scenes.push_back(std::move(scene));
    accepted.particles.push_back(particles);
  }
  return accepted;
}

/// Returns the levels of a scene, and the finest one that is faster than real time by the margin.
RpcResult compute_levels(const ServerResources& resources, const std::string& name) {
  const Scene* const normal = resources.catalogue.find(name);
  if (normal == nullptr) return unknown_scene(name, resources.catalogue);
  const ServerLimits& limits = resources.settings.limits;
  const Levels accepted = accepted_levels(*normal, limits);
  if (accepted.levels.empty()) return limit_reached("particles", limits.max_particles);
  const std::vector<Real> factors = real_time_factors(accepted.scenes, [&](const Scene& scene) {
    return measure_cost(scene, &resources.environment.runner, resources.settings.instructions);
  });
  Json levels = Json::array();
  const char* offered = to_string(accepted.levels.front());
  for (std::size_t i = 0; i < factors.size(); ++i) {
    const char* const level = to_string(accepted.levels[i]);
    levels.push_back(
        {{"level", level}, {"particles", accepted.particles[i]}, {"real_time_factor", factors[i]}});
    if (factors[i] >= kMargin) offered = level;
  }
  return Json{{"levels", std::move(levels)}, {"offered", offered}};
}

/// Samples and measures each scene only once, because other requests wait for it.
RpcResult list_levels(const ServerResources& resources, const std::string& name) {
  const auto known = resources.levels.find(name);
  if (known != resources.levels.end()) return known->second;
  RpcResult result = compute_levels(resources, name);
  // Names of other scenes would let the table grow.
  if (std::holds_alternative<Json>(result)) resources.levels.emplace(name, result);
  return result;
}

}  // namespace

ServerAction read_scene_levels(ObjectReader& params, Errors&) {
  const std::string name = params.text("scene", kMaxNameLength);
  return [name](SessionDirectory& directory, PendingReply& reply) -> std::optional<RpcResult> {
    directory.use_storage(
        reply, [&resources = directory.resources(), name] { return list_levels(resources, name); });
    return {};
  };
}

}  // namespace vat
