#include <algorithm>
#include <cstdio>
#include <limits>
#include <map>
#include <utility>

#include "core/limits.h"
#include "core/neighbours/uniform_grid.h"
#include "core/numerics/choose_numerics.h"
#include "core/numerics/cost_estimate.h"
#include "core/numerics/step_limits.h"
#include "core/sampling/sampling.h"
#include "core/sampling/volumes.h"
#include "core/scene/interface_table.h"
#include "core/scene/lookup.h"
#include "core/validation/validate.h"
#include "core/validation/validate_parts.h"

namespace vat {
namespace {

constexpr Real kOverlap = 0.1;  // in contact distances; smaller overlaps have no effect

std::string number(Real value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

/// All particles of the scene at the start, with their bodies.
struct Start {
  std::vector<SampledBody> bodies;
  std::vector<Vec3> positions;
  std::vector<Real> radii;
  std::vector<Index> body;
};

Start sample_all(const Scene& scene) {
  Start start;
  start.bodies = sample_bodies(scene);
  for (Index index = 0; index < start.bodies.size(); ++index) {
    const SampledBody& sample = start.bodies[index];
    start.positions.insert(start.positions.end(), sample.positions.begin(), sample.positions.end());
    start.radii.insert(start.radii.end(), sample.radii.begin(), sample.radii.end());
    start.body.insert(start.body.end(), sample.positions.size(), index);
  }
  return start;
}

using BodyPair = std::pair<Index, Index>;

/// The number of overlapping pairs of particles, for each pair of bodies.
std::map<BodyPair, std::size_t> count_overlaps(const Scene& scene, const Start& start) {
  std::map<BodyPair, std::size_t> overlaps;
  if (start.radii.empty() || !scene.forces.contacts) return overlaps;
  const Real reach = 2 * std::ranges::max(start.radii);
  UniformGrid grid;
  grid.build(start.positions, reach);
  std::size_t tried = 0;
  for (Index i = 0; i < start.positions.size() && tried <= kMaxSearch; ++i) {
    grid.for_each_run(start.positions[i], reach, [&](Index begin, Index end) {
      tried += end - begin;
      for (Index slot = begin; slot < end; ++slot) {
        const Index j = grid.order()[slot];
        if (start.body[j] >= start.body[i]) continue;
        const Real touching = start.radii[i] + start.radii[j];
        const Real distance = (start.positions[i] - start.positions[j]).norm();
        if (distance < (1 - kOverlap) * touching) ++overlaps[{start.body[j], start.body[i]}];
      }
    });
  }
  return overlaps;
}

void warn_of_overlaps(const Scene& scene, const Start& start, std::vector<Warning>& warnings) {
  for (const auto& [bodies, count] : count_overlaps(scene, start)) {
    warnings.push_back({"bodies_overlap", body_path(bodies.second),
                        "overlaps \"" + scene.bodies[bodies.first].name + "\" at the start, at " +
                            std::to_string(count) +
                            " pairs of particles: they will separate abruptly"});
  }
}

/// The distance from the nearest wall of the vat.
Real wall_gap(const Scene& scene, const Vec3& p) {
  const Vat& vat = *scene.vat;
  Real nearest = std::numeric_limits<Real>::infinity();
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    if (scene.periodic && scene.periodic->axes[static_cast<std::size_t>(axis)]) continue;
    if (scene.dimensions == 2 && axis == 1) continue;
    nearest = std::min(nearest, p[axis] - vat.min[axis]);
    if (axis < 2 || vat.lid) nearest = std::min(nearest, vat.max[axis] - p[axis]);
  }
  return nearest;
}

void warn_of_walls(const Scene& scene, const Start& start, std::vector<Warning>& warnings) {
  if (!scene.vat || !scene.forces.walls) return;
  for (std::size_t b = 0; b < start.bodies.size(); ++b) {
    const SampledBody& sample = start.bodies[b];
    std::size_t count = 0;
    for (std::size_t i = 0; i < sample.positions.size(); ++i) {
      if (wall_gap(scene, sample.positions[i]) < (1 - kOverlap) * sample.radii[i]) ++count;
    }
    if (count > 0) {
      warnings.push_back({"wall_overlap", body_path(b),
                          "overlaps the vat's walls at the start, with " + std::to_string(count) +
                              " particles: it will be pushed away abruptly"});
    }
  }
}

/// In three dimensions, a support radius of 1.3 to 3 spacings has about 8 to 110 neighbours; the
/// kernels of [MCG03] need 20 to 60. One of 4 has about 250, which suits the viscosity of thick
/// liquids.
void warn_of_support(const Scene& scene, std::vector<Warning>& warnings) {
  constexpr Real kLeast = 1.3;
  const Real most = couples_liquids(scene.pressure_solver) ? 4 : 3;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const BodyDescription& body = scene.bodies[b];
    if (body.kind != BodyKind::liquid || body.spacing == 0) continue;
    const Real ratio = material_of(scene, body).liquid->support_radius / body.spacing;
    if (ratio >= kLeast && ratio <= most) continue;
    warnings.push_back({"support_radius", body_path(b) + "/spacing",
                        "the support radius is " + number(ratio) + " spacings; " + number(kLeast) +
                            " to " + number(most) + " are suitable"});
  }
}

void warn_of_loose_particles(const Scene& scene, const Start& start,
                             std::vector<Warning>& warnings) {
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const bool loose = scene.forces.springs && scene.bodies[b].kind == BodyKind::deformable &&
                       start.bodies[b].positions.size() > 1 && start.bodies[b].springs.empty();
    if (loose) {
      warnings.push_back({"no_springs", body_path(b),
                          "has no springs: neither its material nor the body defines any"});
    }
  }
}

void warn_of_steps(const Scene& scene, const Start& start, std::vector<Warning>& warnings) {
  for (const StepLimit& limit : find_step_limits(scene, start.bodies)) {
    const bool is_fixed = scene.numerics.control == StepControl::fixed;
    if (limit.step > 0 && (!is_fixed || scene.numerics.step <= limit.step)) continue;
    const std::string remedy =
        limit.step > 0 ? "is longer than " + number(limit.step) + " s, at which " + limit.reason
                       : "no step is short enough: " + limit.reason;
    warnings.push_back({"unstable_step", "/numerics/step", remedy + " (" + limit.path + ")"});
  }
}

/// The rotation of a rigid body is integrated step by step, accurately up to half a radian in a
/// step.
void warn_of_rotation(const Scene& scene, std::vector<Warning>& warnings) {
  constexpr Real kMaxTurn = 0.5;
  if (scene.numerics.control != StepControl::fixed) return;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const BodyDescription& body = scene.bodies[b];
    if (body.kind != BodyKind::rigid) continue;
    const Real turn = body.angular_velocity.norm() * scene.numerics.step;
    if (turn <= kMaxTurn) continue;
    warnings.push_back({"turns_too_fast", body_path(b) + "/angular_velocity",
                        "rotates by " + number(turn) + " radians in a step: up to " +
                            number(kMaxTurn) + " are accurate"});
  }
}

/// The minimum radius of the bodies of a material, and the number of these bodies.
struct Partners {
  std::size_t count = 0;
  Real least_radius = kMaxLength;
};

/// The minimum distance at which a particle of the body interacts with a wall or another body.
Real least_notice(const Scene& scene, const InterfaceTable& table,
                  const std::vector<Partners>& partners, const BodyDescription& body, Real radius) {
  const std::size_t material = material_index(scene.materials, body.material);
  Real least = std::numeric_limits<Real>::infinity();
  const auto notice = [&](std::optional<std::size_t> interface, Real touching) {
    const bool listed = interface.has_value();
    const auto& law = listed ? scene.interfaces[*interface].constants : scene.default_interface;
    if (law.stiffness == 0 && law.law != InterfaceLaw::projection) return;
    least = std::min(least,
                     listed ? scene.interfaces[*interface].threshold.value_or(touching) : touching);
  };
  for (std::size_t other = 0; scene.forces.contacts && other < partners.size(); ++other) {
    const bool is_same = other == material;
    if (is_same && body.kind == BodyKind::liquid) continue;
    if (partners[other].count <= (is_same ? 1U : 0U)) continue;
    notice(table.between(material, other), radius + partners[other].least_radius);
  }
  if (scene.vat && scene.forces.walls) notice(table.with_walls(material), radius);
  return least;
}

void warn_of_speed(const Scene& scene, const Start& start, std::vector<Warning>& warnings) {
  const InterfaceTable table(scene.materials, scene.interfaces);
  std::vector<Partners> partners(scene.materials.size());
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    Partners& same = partners[material_index(scene.materials, scene.bodies[b].material)];
    ++same.count;
    same.least_radius = std::min(same.least_radius, std::ranges::min(start.bodies[b].radii));
  }
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const SampledBody& sample = start.bodies[b];
    const Real notice =
        least_notice(scene, table, partners, scene.bodies[b], std::ranges::min(sample.radii));
    Real speed = 0;
    for (const Vec3& velocity : sample.velocities) speed = std::max(speed, velocity.norm());
    const bool is_fixed = scene.numerics.control == StepControl::fixed;
    if (!is_fixed || speed * scene.numerics.step <= notice) continue;
    warnings.push_back({"too_fast", body_path(b) + "/velocity",
                        "starts with " + number(speed) +
                            " m/s: in one step it moves further than " + number(notice) +
                            " m, the distance at which it interacts with others"});
  }
}

/// In a perfect lattice, symmetry keeps particles on the streamlines along which voids open.
void warn_of_lattices(const Scene& scene, const Start& start, std::vector<Warning>& warnings) {
  if (scene.pressure_solver != PressureSolver::tait) return;
  if (!fills_world(scene, pointers_to(start.bodies))) return;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const BodyDescription& body = scene.bodies[b];
    if (body.kind != BodyKind::liquid || body.jitter > 0 || body.spacing == 0) continue;
    warnings.push_back({"perfect_lattice", body_path(b) + "/jitter",
                        "fills its world as a perfect lattice, in which flows tear voids; a jitter "
                        "of 0.1 prevents them"});
  }
}

void warn_of_soft_liquids(const Scene& scene, const Start& start, std::vector<Warning>& warnings) {
  constexpr Real kShare = 0.1;
  const bool is_pressed = scene.forces.gravity && scene.forces.pressure;
  if (scene.pressure_solver != PressureSolver::tait || !is_pressed) return;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const BodyDescription& body = scene.bodies[b];
    if (body.kind != BodyKind::liquid) continue;
    const std::size_t m = material_index(scene.materials, body.material);
    const Real least = weight_of(scene, start.bodies[b]) / kShare;
    if (scene.materials[m].liquid->stiffness >= least) continue;
    warnings.push_back({"soft_liquid", "/materials/" + std::to_string(m) + "/liquid/stiffness",
                        "is below " + number(least) +
                            ", ten times the liquid's own weight over its "
                            "density: at the bottom it is compressed by more than a tenth"});
  }
}

void warn_of_cost(const Scene& scene, const Start& start, std::vector<Warning>& warnings) {
  constexpr Real kMuchMemory = 1e9;
  const CostEstimate cost = estimate_cost(scene, pointers_to(start.bodies));
  if (cost.seconds > 1) {
    warnings.push_back({"slow", "/numerics/step",
                        "needs about " + number(cost.seconds) +
                            " s of one core for a simulated second, without contacts"});
  }
  if (cost.memory > kMuchMemory) {
    warnings.push_back(
        {"much_memory", "/bodies", "need about " + number(cost.memory / 1e9) + " GB of memory"});
  }
}

}  // namespace

std::vector<Warning> find_warnings(const Scene& given) {
  const Start start = sample_all(given);
  Scene scene = given;
  scene.numerics = choose_numerics(given, pointers_to(start.bodies));
  std::vector<Warning> warnings;
  warn_of_overlaps(scene, start, warnings);
  warn_of_walls(scene, start, warnings);
  warn_of_support(scene, warnings);
  warn_of_loose_particles(scene, start, warnings);
  warn_of_idle_settings(scene, warnings);
  warn_of_rotation(scene, warnings);
  warn_of_speed(scene, start, warnings);
  warn_of_steps(scene, start, warnings);
  warn_of_lattices(scene, start, warnings);
  warn_of_soft_liquids(scene, start, warnings);
  warn_of_cost(scene, start, warnings);
  return warnings;
}

}  // namespace vat
