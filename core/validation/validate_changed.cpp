#include <algorithm>
#include <array>
#include <string_view>

#include "core/limits.h"
#include "core/numerics/pair_limits.h"
#include "core/scene/lookup.h"
#include "core/support/check.h"
#include "core/validation/validate.h"
#include "core/validation/validate_parts.h"

namespace vat {
namespace {

/// Checks the description of a liquid whose particles are known: its name, material and radius.
void check_known(const Scene& scene, const BodyDescription& body, const std::string& path,
                 RangeCheck& check) {
  check.text(body.name, kMaxNameLength, false, path + "/name");
  const auto material = std::ranges::find(scene.materials, body.material, &Material::name);
  const bool is_liquid = body.kind == BodyKind::liquid && !body.melting &&
                         material != scene.materials.end() && material->liquid;
  if (!is_liquid) check.add("not_liquid", path, "must be a liquid, of a material for liquids");
  if (body.radius) check.real(*body.radius, kMinLength, kMaxLength, path + "/radius");
}

/// The parts of the scene that do not depend on bodies.
Scene without_bodies(const Scene& scene) {
  Scene world = scene;
  world.bodies.clear();
  world.emitters.clear();
  world.numerics.accuracy.reset();  // the numerics are resolved
  return world;
}

/// The scene without the limits of initial positions and of the speed of flow.
Scene without_bounds(const Scene& scene) {
  Scene open = scene;
  open.vat.reset();
  open.numerics.step = kMinStep;
  return open;
}

/// Paths of the numerics that can change while a simulation runs.
constexpr std::array<std::string_view, 6> kChangeable{"/numerics/integrator",
                                                      "/numerics/step",
                                                      "/numerics/control",
                                                      "/numerics/tolerance",
                                                      "/incompressible/density_tolerance",
                                                      "/incompressible/divergence_tolerance"};

}  // namespace

Errors find_numerics_errors(const Scene& scene) {
  Errors errors = find_errors(without_bodies(scene));
  const std::string own = "/numerics";
  for (Error& error : errors) {
    if (std::ranges::find(kChangeable, error.path) != kChangeable.end()) {
      error.path = error.path.substr(error.path.rfind('/'));
      continue;
    }
    error.message = error.path + " would be invalid: " + error.message;
    error.path = error.path == own + "/tick" ? "/step" : "/integrator";
  }
  return errors;
}

Errors find_changed_errors(const Scene& scene, const std::vector<const SampledBody*>& known) {
  Errors errors = find_errors(without_bodies(scene));
  VAT_CHECK(known.size() == scene.bodies.size());
  if (!errors.empty()) return errors;
  RangeCheck check(errors);
  if (scene.bodies.size() > kMaxBodies) check.add("too_many", "/bodies", "too many bodies");
  const Scene open = without_bounds(scene);
  std::vector<SampledBody> samples(scene.bodies.size());
  std::vector<PairBody> pairs;
  Allowance total;
  for (std::size_t b = 0; b < scene.bodies.size() && errors.empty(); ++b) {
    const BodyDescription& body = scene.bodies[b];
    const std::string path = body_path(b);
    const SampledBody* sample = known[b];
    if (sample != nullptr) {
      check_known(scene, body, path, check);
    } else {
      Allowance own;
      samples[b] = check_body(open, Vec3::Zero(), body, path, own, check).value_or(SampledBody{});
      sample = &samples[b];
    }
    total.take_particles(sample->positions.size());
    total.take_springs(sample->springs.size());
    total.check_totals("/bodies", check);
    pairs.push_back({&body, sample->positions, sample->radii});
  }
  if (errors.empty()) check_flow(open, errors);
  if (errors.empty()) check_periods(scene, pairs, "/periodic/max", check);
  return errors;
}

}  // namespace vat
