#include "core/validation/validate.h"

#include <algorithm>
#include <set>
#include <utility>

#include "core/limits.h"
#include "core/numerics/pair_limits.h"
#include "core/sampling/melting.h"
#include "core/sampling/nozzle.h"
#include "core/scene/interface_table.h"
#include "core/scene/lookup.h"
#include "core/support/check.h"
#include "core/validation/validate_parts.h"

namespace vat {

namespace {

std::string element(const char* list, std::size_t index) {
  return list + ('/' + std::to_string(index));
}

/// The setting of the scene that excludes surface tension; empty if there is none. The gas solver
/// conserves no energy, so that its surface heats up. An incompressible liquid has no tension,
/// which cohesion needs. The corrections of a surface hold for Wendland's kernel.
std::string adverse_to_surfaces(const Scene& scene) {
  const bool is_cohesive = scene.surface_model == SurfaceModel::cohesion;
  if (scene.pressure_solver == PressureSolver::gas) return "the pressure solver \"gas\"";
  if (scene.kernel != KernelId::wendland_c2) {
    return std::string("the kernel \"") + to_string(scene.kernel) + '"';
  }
  if (is_cohesive && scene.pressure_solver == PressureSolver::incompressible) {
    return "the model \"cohesion\" and the pressure solver \"incompressible\"";
  }
  return "";
}

void check_surface_tension(const Scene& scene, RangeCheck& check) {
  const std::string reason = adverse_to_surfaces(scene);
  if (reason.empty()) return;
  for (std::size_t m = 0; m < scene.materials.size(); ++m) {
    const std::optional<LiquidConstants>& liquid = scene.materials[m].liquid;
    if (!liquid || liquid->surface_tension == 0) continue;
    check.add("not_allowed", element("/materials", m) + "/liquid/surface_tension",
              "must be 0 with " + reason);
  }
}

void check_incompressible(const Scene& scene, RangeCheck& check) {
  const IncompressibleSolve& solve = scene.incompressible;
  check.real(solve.density_tolerance, kMinVolumeTolerance, kMaxVolumeTolerance,
             "/incompressible/density_tolerance");
  check.real(solve.divergence_tolerance, kMinVolumeTolerance, kMaxVolumeTolerance,
             "/incompressible/divergence_tolerance");
  check.real(solve.most_iterations, kMinIterations, kMaxIterations,
             "/incompressible/most_iterations");
  const Numerics& numerics = scene.numerics;
  const bool drives = numerics.accuracy || numerics.integrator == IntegratorId::symplectic_euler;
  if (scene.pressure_solver != PressureSolver::incompressible || drives) return;
  check.add(
      "not_allowed", "/numerics/integrator",
      std::string("the pressure solver \"incompressible\" needs \"symplectic_euler\", not \"") +
          to_string(numerics.integrator) + '"');
}

/// Checks that coupled liquids have one support radius.
void check_coupled_liquids(const Scene& scene, RangeCheck& check) {
  if (scene.pressure_solver == PressureSolver::gas) return;
  std::optional<Real> support;
  for (std::size_t m = 0; m < scene.materials.size(); ++m) {
    const std::optional<LiquidConstants>& liquid = scene.materials[m].liquid;
    if (!liquid) continue;
    if (support && liquid->support_radius != *support) {
      check.add(
          "out_of_range", element("/materials", m) + "/liquid/support_radius",
          std::string("must be that of the scene's other liquids with the pressure solver \"") +
              to_string(scene.pressure_solver) + '"');
    }
    support = support.value_or(liquid->support_radius);
  }
}

void check_material(const Material& material, const std::string& path, RangeCheck& check) {
  check.text(material.name, kMaxNameLength, false, path + "/name");
  if (material.name == kVatMaterial) {
    check.add("reserved_name", path + "/name", "must not be \"vat\": that names the walls");
  }
  check_members(material, path, check);
  if (material.liquid) check_members(*material.liquid, path + "/liquid", check);
  if (material.self_contact) check_members(*material.self_contact, path + "/self_contact", check);
  if (material.plasticity) check_members(*material.plasticity, path + "/plasticity", check);
  check_members(material.appearance, path + "/appearance", check);
  check_spring_changes(material, path, check);
  if (!material.springs) return;
  const auto lattice = [&](const std::optional<SpringConstants>& constants, const char* name) {
    if (constants) check_members(*constants, path + "/springs/" + name, check);
  };
  lattice(material.springs->structural, "structural");
  lattice(material.springs->shear, "shear");
  lattice(material.springs->bend, "bend");
}

void check_materials(const Scene& scene, RangeCheck& check) {
  if (scene.materials.size() > kMaxMaterials) {
    check.add("too_many", "/materials", "at most " + std::to_string(kMaxMaterials) + " materials");
  }
  std::set<std::string> names;
  for (std::size_t m = 0; m < scene.materials.size(); ++m) {
    const std::string path = element("/materials", m);
    check_material(scene.materials[m], path, check);
    if (!names.insert(scene.materials[m].name).second) {
      check.add("duplicate", path + "/name", "must not be the name of an earlier material");
    }
  }
}

/// Checks that the numerics support the laws. If the scene has an accuracy, it chooses suitable
/// numerics.
void check_laws(const Scene& scene, RangeCheck& check) {
  if (scene.numerics.accuracy) return;
  check_law_numerics(scene.numerics, scene.default_interface, "/default_interface", check);
  for (std::size_t i = 0; i < scene.interfaces.size(); ++i) {
    check_law_numerics(scene.numerics, scene.interfaces[i].constants, element("/interfaces", i),
                       check);
  }
}

void check_bodies(const Scene& scene, RangeCheck& check, std::vector<SampledBody>& samples) {
  if (scene.bodies.size() > kMaxBodies) {
    check.add("too_many", "/bodies", "at most " + std::to_string(kMaxBodies) + " bodies");
    return;
  }
  Allowance allowance;
  std::set<std::string> names;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const std::string path = element("/bodies", b);
    auto sample = check_body(scene, Vec3::Zero(), scene.bodies[b], path, allowance, check);
    if (sample) samples.push_back(std::move(*sample));
    if (!names.insert(scene.bodies[b].name).second) {
      check.add("duplicate", path + "/name", "must not be the name of an earlier body");
    }
  }
  allowance.check_totals("/bodies", check);
}

CurrentScene present_of(const std::vector<SampledBody>& samples) {
  CurrentScene present;
  for (const SampledBody& sample : samples) {
    present.bodies.push_back({sample.positions, sample.radii, sample.springs.size()});
  }
  return present;
}

std::vector<PairBody> pair_bodies(const Scene& scene, const CurrentScene& present) {
  /// The bodies of a scene with their present particles, for the count of pairs.
  VAT_CHECK(present.bodies.size() == scene.bodies.size());
  std::vector<PairBody> pairs;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    pairs.push_back({&scene.bodies[b], present.bodies[b].positions, present.bodies[b].radii});
  }
  return pairs;
}

}  // namespace

/// Checks periods and the numbers of neighbours.
void check_neighbours(const Scene& scene, const CurrentScene& present,
                      const std::string& periods_path, const std::string& pairs_path,
                      RangeCheck& check) {
  const std::vector<PairBody> pairs = pair_bodies(scene, present);
  if (check_periods(scene, pairs, periods_path, check)) {
    check_pairs(scene, pairs, pairs_path, check);
  }
}

/// Checks the number of particles for all that emitters may add.
void check_room(const Scene& scene, const std::vector<SampledBody>& samples, RangeCheck& check) {
  Allowance allowance;
  for (std::size_t b = 0; b < samples.size(); ++b) {
    allowance.take_particles(
        std::max(samples[b].positions.size(), most_particles(scene, scene.bodies[b])));
  }
  if (allowance.is_exceeded()) {
    check.add(
        "too_many", "/emitters",
        "the bodies may grow to at most " + std::to_string(kMaxParticles) + " particles in all");
  }
}

Errors find_errors(const Scene& scene) {
  Errors errors;
  RangeCheck check(errors);
  check.text(scene.name, kMaxNameLength, true, "/name");
  check.text(scene.title, kMaxTextLength, true, "/title");
  check.text(scene.description, kMaxTextLength, true, "/description");
  check.vector(scene.gravity, -kMaxGravity, kMaxGravity, "/gravity");
  check_materials(scene, check);
  check_interfaces(scene, check);
  check_laws(scene, check);
  check_incompressible(scene, check);
  check_coupled_liquids(scene, check);
  check_surface_tension(scene, check);
  if (scene.dimensions != 2 && scene.dimensions != 3) {
    check.add("out_of_range", "/dimensions", "must be 2 or 3");
  }
  if (scene.periodic) check_periodicity(*scene.periodic, check);
  if (scene.central_field) check_central_field(*scene.central_field, check);
  if (scene.settling) check_settling(*scene.settling, check);
  if (scene.sleeping) check_sleeping(*scene.sleeping, check);
  if (scene.vat) check_vat(scene, check);
  if (scene.dimensions == 2) check_plane(scene, check);
  check_numerics(scene, check);
  check_spring_numerics(scene, check);
  std::vector<SampledBody> samples;
  check_bodies(scene, check, samples);
  if (!errors.empty()) return errors;
  check_flow(scene, errors);
  check_room(scene, samples, check);
  if (!errors.empty()) return errors;
  check_accuracy(scene, samples, check);
  const CurrentScene present = present_of(samples);
  check_neighbours(scene, present, "/periodic/max", "/bodies", check);
  const bool melts = std::ranges::any_of(
      scene.bodies, [](const BodyDescription& body) { return body.melting.has_value(); });
  if (melts && errors.empty()) {
    check_neighbours(with_all_melted(scene, samples), present, "/periodic/max", "/bodies", check);
  }
  return errors;
}

Errors find_body_errors(const Scene& scene, const CurrentScene& present,
                        const BodyDescription& body, const std::string& path) {
  Errors errors;
  RangeCheck check(errors);
  if (scene.bodies.size() >= kMaxBodies) {
    check.add("too_many", path, "at most " + std::to_string(kMaxBodies) + " bodies");
    return errors;
  }
  if (std::ranges::find(scene.bodies, body.name, &BodyDescription::name) != scene.bodies.end()) {
    check.add("duplicate", path + "/name", "must not be the name of another body");
  }
  Allowance allowance;
  for (std::size_t b = 0; b < present.bodies.size(); ++b) {
    const CurrentBody& other = present.bodies[b];
    allowance.take_particles(
        std::max(other.positions.size(), most_particles(scene, scene.bodies[b])));
    allowance.take_springs(other.springs);
  }
  check_new_solid(scene, body, path, check);
  const auto sample = check_body(scene, present.vat_offset, body, path, allowance, check);
  allowance.check_totals(path, check);
  if (!errors.empty()) return errors;
  std::vector<PairBody> pairs = pair_bodies(scene, present);
  pairs.push_back({&body, sample->positions, sample->radii});
  if (check_periods(scene, pairs, path, check)) check_pairs_of_new(scene, pairs, path, check);
  return errors;
}

Errors find_body_errors(const Scene& scene, const BodyDescription& body, const std::string& path) {
  std::vector<SampledBody> samples;
  for (const BodyDescription& other : scene.bodies) {
    samples.push_back(sample_body(other, material_of(scene, other), scene.dimensions));
  }
  return find_body_errors(scene, present_of(samples), body, path);
}

Errors find_interface_errors(const Scene& scene, const CurrentScene& present,
                             const InterfaceDescription& interface, const std::string& path) {
  Errors errors;
  RangeCheck check(errors);
  check_interface(scene, interface, path, check);
  check_law_numerics(scene.numerics, interface.constants, path, check);
  if (!errors.empty()) return errors;
  Scene changed = scene;
  changed.interfaces.push_back(interface);  // the last of a pair of materials counts
  const std::vector<PairBody> pairs = pair_bodies(changed, present);
  if (check_periods(changed, pairs, path, check)) {
    check_contact_pairs(changed, pairs, path, check);
  }
  return errors;
}

Errors find_melting_errors(const Scene& scene, const CurrentScene& present, std::size_t body,
                           const std::string& into) {
  Errors errors;
  VAT_CHECK(body < scene.bodies.size());
  RangeCheck check(errors);
  check_melting(scene, scene.bodies[body], into, "/body", "/material", check);
  if (!errors.empty()) return errors;
  Scene changed = scene;
  changed.bodies[body].kind = BodyKind::liquid;
  changed.bodies[body].material = into;
  check_neighbours(changed, present, "/body", "/body", check);
  return errors;
}

namespace {

constexpr const char* kPositionPath = "/position";

/// The errors of a body at its present position. `check_its_pairs(pairs, check)` checks its
/// neighbours.
template <class CheckPairs>
Errors find_placed_errors(const Scene& scene, const CurrentScene& present, std::size_t body,
                          CheckPairs&& check_its_pairs) {
  Errors errors;
  RangeCheck check(errors);
  const std::span<const Vec3> positions = present.bodies[body].positions;
  if (scene.vat) check_inside_vat(scene, present.vat_offset, positions, kPositionPath, check);
  if (!errors.empty()) return errors;
  const std::vector<PairBody> pairs = pair_bodies(scene, present);
  if (check_periods(scene, pairs, kPositionPath, check)) check_its_pairs(pairs, check);
  return errors;
}

}  // namespace

Errors find_moved_errors(const Scene& scene, const CurrentScene& present, std::size_t body) {
  return find_placed_errors(scene, present, body, [&](const auto& pairs, RangeCheck& check) {
    check_pairs_of_moved(scene, pairs, body, kPositionPath, check);
  });
}

Errors find_returned_errors(const Scene& scene, const CurrentScene& present) {
  VAT_CHECK(!scene.bodies.empty() && present.bodies.size() == scene.bodies.size());
  const std::size_t last = scene.bodies.size() - 1;
  return find_placed_errors(scene, present, last, [&](const auto& pairs, RangeCheck& check) {
    check_pairs_of_new(scene, pairs, kPositionPath, check);
  });
}

Scene with_material(Scene scene, const Material& material) {
  const auto found = std::ranges::find(scene.materials, material.name, &Material::name);
  if (found == scene.materials.end()) {
    scene.materials.push_back(material);
  } else {
    *found = material;
  }
  return scene;
}

Errors find_material_errors(const Scene& scene, const CurrentScene& present,
                            const std::vector<const SampledBody*>& known, const Material& material,
                            const std::string& path) {
  const Scene changed = with_material(scene, material);
  const std::string own = element("/materials", material_index(changed.materials, material.name));
  Errors errors = find_changed_errors(changed, known);
  for (Error& error : errors) {
    const bool is_own = error.path == own || error.path.starts_with(own + '/');
    if (!is_own) error.message = error.path + " would be invalid: " + error.message;
    error.path = is_own ? path + error.path.substr(own.size()) : path;
  }
  RangeCheck check(errors);
  if (errors.empty()) check_neighbours(changed, present, path, path, check);
  return errors;
}

Errors find_moved_vat_errors(const Scene& scene, const Vec3& offset) {
  const std::string path = "/offset";
  if (!scene.vat) return {Error{"no_vat", path, "the scene has no vat"}};
  Errors errors;
  RangeCheck check(errors);
  const Real side = (scene.vat->max - scene.vat->min).maxCoeff();
  check.vector(offset, -side, side, path);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const bool repeats = scene.periodic && scene.periodic->axes[axis];
    if (!repeats || offset[static_cast<Eigen::Index>(axis)] == 0) continue;
    check.add("not_allowed", path,
              std::string("must be 0 along the periodic axis ") + kAxisNames[axis]);
  }
  if (scene.dimensions == 2 && offset.y() != 0) {
    check.add("off_plane", path, "must have y = 0 in a scene of two dimensions");
  }
  if (!errors.empty() || (scene.emitters.empty() && scene.drains.empty())) return errors;
  Scene moved = scene;
  moved.vat->min += offset;
  moved.vat->max += offset;
  check_flow(moved, errors);
  for (Error& error : errors) {
    error.message = error.path + " would be invalid: " + error.message;
    error.path = path;
  }
  return errors;
}

}  // namespace vat
