#include "core/numerics/step_limits.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

#include "core/laws/cell_volume.h"
#include "core/laws/surface_tension.h"
#include "core/numerics/contact_limits.h"
#include "core/sampling/volumes.h"
#include "core/scene/lookup.h"
#include "core/support/check.h"

namespace vat {
namespace {

constexpr Real kSoundLimit = 0.96;     // c dt / h, velocity Verlet, cubic lattice, h = 2 spacings
constexpr Real kViscousLimit = 0.126;  // nu dt / h^2, the same, 2 / (greatest eigenvalue)
constexpr Real kNoSlipShare = 2.5;  // the drag of a wall is up to 1.5 times that of the neighbours
constexpr Real kVerletLimit = 2;    // omega dt and rate dt at these limits

/// Limits of liquids with a smoothing kernel: the minimum for 2 to 4 spacings in a support radius.
struct KernelLimits {
  Real sound;
  Real viscous;
};
constexpr KernelLimits limits_of(KernelId kernel) {
  return kernel == KernelId::cubic_spline ? KernelLimits{0.91, 0.03} : KernelLimits{0.86, 0.028};
}

struct SpringBound {
  Oscillation greatest;
  Real least_ratio = std::numeric_limits<Real>::infinity();  ///< damping / stiffness [s]
};

/// A symmetric tensor: xx, yy, zz, xy, xz, yz.
using Symmetric = std::array<Real, 6>;

Symmetric along(const Vec3& x) {
  const Real length = x.norm();
  if (!(length > 0)) return {1, 1, 1, 0, 0, 0};
  const Real length2 = length * length;
  return {x[0] * x[0] / length2, x[1] * x[1] / length2, x[2] * x[2] / length2,
          x[0] * x[1] / length2, x[0] * x[2] / length2, x[1] * x[2] / length2};
}

void add(Real factor, const Symmetric& tensor, Symmetric& sum) {
  for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += factor * tensor[c];
}

Mat3 matrix_of(const Symmetric& t) {
  Mat3 matrix;
  matrix << t[0], t[3], t[4], t[3], t[1], t[5], t[4], t[5], t[2];
  return matrix;
}

/// max_i 2 lambda_max(load_i) / m_i.
Real greatest_load(const SampledBody& body, const std::vector<Symmetric>& loads) {
  Real greatest = 0;
  Eigen::SelfAdjointEigenSolver<Mat3> solver;
  for (std::size_t i = 0; i < loads.size(); ++i) {
    const Mat3 load = matrix_of(loads[i]);
    if (2 * load.trace() <= greatest * body.masses[i]) continue;  // its eigenvalues are below
    solver.compute(load, Eigen::EigenvaluesOnly);
    greatest = std::max(greatest, 2 * solver.eigenvalues()[2] / body.masses[i]);
  }
  return greatest;
}

/// Bounds for the springs: loads sum_j k_ij n n^T on the free particles, with k the constants of
/// the springs.
SpringBound bound_springs(const SampledBody& body) {
  SpringBound bound;
  if (body.springs.empty()) return bound;
  std::vector<Symmetric> stiffness(body.positions.size());
  std::vector<Symmetric> damping(body.positions.size());
  for (const SampledSpring& spring : body.springs) {
    const Symmetric direction = along(body.positions[spring.a] - body.positions[spring.b]);
    for (const Index end : {spring.a, spring.b}) {
      add(spring.stiffness, direction, stiffness[end]);
      add(spring.damping, direction, damping[end]);
    }
    if (spring.stiffness == 0) continue;
    bound.least_ratio = std::min(bound.least_ratio, spring.damping / spring.stiffness);
  }
  for (const Index fixed : body.fixed) stiffness[fixed] = damping[fixed] = {};
  bound.greatest = {greatest_load(body, stiffness), greatest_load(body, damping)};
  return bound;
}

/// Adds both damping extremes: strong damping limits some integrators, and weak damping others.
void add_solid(const Scene& scene, std::size_t index, const SampledBody& body,
               std::vector<OscillatingPart>& parts) {
  const Material& material = material_of(scene, scene.bodies[index]);
  const bool is_implicit = has_implicit_springs(scene, material);
  const SpringBound springs = is_implicit ? SpringBound{} : bound_springs(body);
  const Oscillation cells{bound_cells(body, material.bulk_modulus, scene.dimensions), 0};
  const auto add = [&](const Oscillation& oscillation) {
    parts.push_back({body_path(index), "its springs may become unstable",
                     "undamped springs gain energy with this integrator", oscillation, index});
  };
  const Oscillation& greatest = springs.greatest;
  if (is_implicit && body.cells.empty()) return;
  add(greatest + cells);
  if (greatest.omega2 > 0) {
    add(Oscillation{greatest.omega2, springs.least_ratio * greatest.omega2} + cells);
  }
}

/// The forces that hold a surface together. With curvature, they act as a sound of c^2 = 2
/// kCohesion sigma / (rho h). With cohesion, density waves of wave number k have omega^2 = A k^2
/// (W'(k) - W(k)) / rho, with the Fourier transforms W and W' of both parts, at most 8.6 A / (rho
/// h^2).
Real cohesion_omega2(const Scene& scene, const Material& material) {
  const LiquidConstants& liquid = *material.liquid;
  const Real h = liquid.support_radius;
  if (scene.surface_model == SurfaceModel::cohesion) {
    constexpr Real kGreatest = 8.6;
    const Real attraction = attraction_of(liquid.surface_tension, h, scene.dimensions);
    return kGreatest * attraction / (material.density * h * h);
  }
  const Real limit = kVerletLimit / limits_of(scene.kernel).sound;
  return limit * limit * 2 * kCohesion * liquid.surface_tension / (material.density * h * h * h);
}

/// The shortest waves of a surface of these particles, two spacings long, need dt <= sqrt(rho
/// spacing^3 / (2 pi sigma)) (J. U. Brackbill, D. B. Kothe, C. Zemach, J. Comput. Phys. 100 (1992)
/// 335, eq. 61).
Real surface_omega2(const Scene& scene, const Material& material, Real spacing) {
  const LiquidConstants& liquid = *material.liquid;
  if (liquid.surface_tension == 0 || spacing == 0) return 0;
  const Real waves = 2 * std::numbers::pi / (spacing * spacing * spacing);
  return kVerletLimit * kVerletLimit * waves * liquid.surface_tension / material.density +
         cohesion_omega2(scene, material);
}

/// The pressure of the liquid's own weight, for its depth at the start.
Real weight_omega2(const Scene& scene, const SampledBody& body, Real support_radius) {
  if (!scene.forces.pressure || !scene.forces.gravity) return 0;
  return pressed_lattice_omega2(weight_of(scene, body), support_radius);
}

/// The sound, viscosity and settling of a liquid of this material.
Oscillation bound_liquid(const Scene& scene, const Material& material) {
  const LiquidConstants& liquid = *material.liquid;
  const Real h = liquid.support_radius;
  const bool is_coupled = couples_liquids(scene.pressure_solver);
  const bool has_sound =
      scene.forces.pressure && scene.pressure_solver != PressureSolver::incompressible;
  const Real speed = has_sound ? std::sqrt(liquid.stiffness) : 0;
  const Real tait_limit = limits_of(scene.kernel).sound * compressed_step_share(scene.dimensions);
  const Real sound = kVerletLimit / (is_coupled ? tait_limit : kSoundLimit) * speed / h;
  Real viscosity = scene.forces.viscosity ? liquid.viscosity / material.density : 0;
  if (is_coupled && scene.forces.viscosity) {
    viscosity += liquid.artificial_viscosity * speed * h / (4 * (scene.dimensions + 2));
  }
  const auto is_no_slip = [](const Wall& wall) { return wall.no_slip; };
  if (scene.vat && std::ranges::any_of(scene.vat->walls, is_no_slip)) viscosity *= kNoSlipShare;
  const Real viscous_limit = is_coupled ? limits_of(scene.kernel).viscous : kViscousLimit;
  const Real drag = scene.settling ? scene.settling->drag : 0;
  return {sound * sound, kVerletLimit / viscous_limit * viscosity / (h * h) + drag};
}

/// The material of a liquid, or of the liquid into which a body melts; null for others.
const Material* liquid_of(const Scene& scene, const BodyDescription& body) {
  if (body.kind != BodyKind::liquid && !body.melting) return nullptr;
  const std::string& name = body.melting ? body.melting->into : body.material;
  const auto found = std::ranges::find(scene.materials, name, &Material::name);
  VAT_CHECK(found != scene.materials.end());
  return &*found;
}

void add_liquid(const Scene& scene, std::size_t index, const SampledBody& sample,
                std::vector<OscillatingPart>& parts) {
  const BodyDescription& body = scene.bodies[index];
  const Material& material = *liquid_of(scene, body);
  Oscillation bound = bound_liquid(scene, material);
  Real spacing = body.spacing;  // of the particles that an emitter will add
  if (!sample.masses.empty()) {
    spacing = std::pow(std::ranges::min(sample.masses) / material.density, 1.0 / scene.dimensions);
  }
  bound.omega2 += surface_omega2(scene, material, spacing);
  OscillatingPart part{body_path(index), "sound or viscosity in the liquid becomes unstable",
                       "sound in an inviscid liquid gains energy with this integrator", bound,
                       index};
  if (scene.pressure_solver == PressureSolver::incompressible) {
    part.bound.omega2 += weight_omega2(scene, sample, material.liquid->support_radius);
    part.reason = "pressure in the liquid becomes unstable";
    part.gains = "a liquid under pressure gains energy with this integrator";
  }
  if (body.melting) {
    part.path += kMeltingPath;
    part.body.reset();  // the body is not liquid yet
  }
  parts.push_back(std::move(part));
}

/// A solid in a coupled liquid: the forces on liquid of the same volume act on the mass of the
/// solid. No limit if the solid is denser than the liquid.
void add_wet_solid(const Scene& scene, std::size_t index, const SampledBody& sample,
                   std::vector<OscillatingPart>& parts) {
  Real lightest = std::numeric_limits<Real>::infinity();  // density
  const std::vector<Real> volumes = particle_volumes(scene, index, sample);
  for (std::size_t i = 0; i < volumes.size(); ++i) {
    lightest = std::min(lightest, sample.masses[i] / volumes[i]);
  }
  Oscillation bound;
  for (const BodyDescription& body : scene.bodies) {
    const Material* liquid_material = liquid_of(scene, body);
    if (liquid_material == nullptr || &body == &scene.bodies[index]) continue;
    const Material& material = *liquid_material;
    // Neighbours move in opposite directions in the highest modes of a liquid. A rigid body moves
    // as a whole; against liquid at rest, the relative displacement is half of that.
    const Real share = scene.bodies[index].kind == BodyKind::rigid ? 0.5 : 1;
    const Real ratio = share * material.density / lightest;
    if (ratio <= 1) continue;
    Oscillation liquid = bound_liquid(scene, material);
    if (scene.surface_model == SurfaceModel::cohesion) {
      liquid.omega2 += cohesion_omega2(scene, material);  // cohesion attracts the solid as well
    }
    bound = {std::max(bound.omega2, ratio * liquid.omega2),
             std::max(bound.rate, ratio * liquid.rate)};
  }
  if (bound.omega2 == 0 && bound.rate == 0) return;
  parts.push_back({body_path(index), "it is so light that it becomes unstable in the liquid",
                   "a body in an inviscid liquid gains energy with this integrator", bound, index});
  parts.back().is_of_liquid_on_solid = true;
}

}  // namespace

Real pressed_lattice_omega2(Real pressure, Real support_radius) {
  constexpr Real kLimit = 0.18;  // dt sqrt(p / rho) / h
  VAT_CHECK(support_radius > 0);
  const Real rate = kVerletLimit / (kLimit * support_radius);
  return rate * rate * pressure;
}

Real bound_cells(const SampledBody& body, Real bulk_modulus, int dimensions) {
  std::vector<Real> load(body.positions.size(), 0);
  VAT_CHECK(body.masses.size() == body.positions.size());
  const Index count = dimensions == 3 ? 8 : 4;
  for (const SampledCell& cell : body.cells) {
    std::array<Real, 8> slope{};
    Real sum = 0;
    for (Index c = 0; c < count; ++c) {
      slope[c] = cell_slope(body.positions, cell.corners, c, dimensions).norm();
      sum += slope[c];
    }
    for (Index c = 0; c < count; ++c) {
      load[cell.corners[c]] += bulk_modulus / cell.volume * slope[c] * sum;
    }
  }
  Real greatest = 0;
  for (std::size_t i = 0; i < load.size(); ++i) {
    greatest = std::max(greatest, load[i] / body.masses[i]);
  }
  return greatest;
}

bool has_implicit_springs(const Scene& scene, const Material& material) {
  return scene.forces.springs && material.implicit_springs;
}

Real weight_of(const Scene& scene, const SampledBody& body) {
  Real top = -std::numeric_limits<Real>::infinity();
  Real bottom = std::numeric_limits<Real>::infinity();
  for (const Vec3& position : body.positions) {
    const Real height = -scene.gravity.dot(position);
    top = std::max(top, height);
    bottom = std::min(bottom, height);
  }
  return std::max(Real{0}, top - bottom);
}

bool solves_damping(const Scene& scene) {
  return scene.pressure_solver == PressureSolver::incompressible && scene.forces.pressure &&
         scene.numerics.control != StepControl::local;
}

Real compressed_step_share(int dimensions) {
  return dimensions == 2 ? 0.82 : 0.9;
}

std::vector<OscillatingPart> find_parts_of_body(const Scene& scene, std::size_t body,
                                                const SampledBody& sample) {
  std::vector<OscillatingPart> parts;
  const BodyDescription& description = scene.bodies[body];
  if (liquid_of(scene, description) != nullptr) add_liquid(scene, body, sample, parts);
  if (description.kind != BodyKind::liquid) {
    if (scene.forces.springs) add_solid(scene, body, sample, parts);
    if (couples_liquids(scene.pressure_solver)) add_wet_solid(scene, body, sample, parts);
  }
  for (OscillatingPart& part : parts) part.damping_is_solved = solves_damping(scene);
  return parts;
}

std::vector<OscillatingPart> find_oscillating_parts(const Scene& scene,
                                                    std::span<const SampledBody* const> samples) {
  std::vector<OscillatingPart> parts;
  VAT_CHECK(samples.size() == scene.bodies.size());
  for (std::size_t b = 0; b < samples.size(); ++b) {
    std::ranges::move(find_parts_of_body(scene, b, *samples[b]), std::back_inserter(parts));
  }
  add_contact_limits(scene, samples, parts);
  return parts;
}

std::vector<StepLimit> find_step_limits(const Scene& scene,
                                        const std::vector<SampledBody>& samples) {
  std::vector<StepLimit> limits;
  for (OscillatingPart& part : find_oscillating_parts(scene, pointers_to(samples))) {
    const Real step = stable_step(scene.numerics.integrator, part.limiting());
    if (!std::isfinite(step)) continue;
    const bool is_same = !limits.empty() && limits.back().path == part.path;
    if (is_same && limits.back().step <= step) continue;
    if (is_same) limits.pop_back();
    limits.push_back({std::move(part.path), std::move(step > 0 ? part.reason : part.gains), step});
  }
  return limits;
}

}  // namespace vat
