#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/validation/cases.h"
#include "tests/validation/cases/liquid_dam_break.h"
#include "tests/validation/cases/liquid_fit.h"
#include "tests/validation/cases/liquid_rest.h"
#include "tests/validation/reference.h"

// The incompressible liquid, and beside it the weakly compressible one: their errors against the
// seconds that the rows have.

namespace vat::validation {

namespace {

constexpr Real kGravity = 9.81;
const char* const kTarget = "twice the error that a weakly compressible liquid may have";

/// The scene's liquid at rest density with this solver, in adaptive steps of at most `step`.
/// `speed`: the greatest that is expected [m/s].
Scene with_solver(Scene scene, PressureSolver solver, Real spacing, Real speed, Real step) {
  const bool is_tait = solver == PressureSolver::tait;
  scene.pressure_solver = solver;
  scene.interfaces.clear();
  scene.bodies[0].spacing = spacing;
  scene.bodies[0].mass.reset();
  LiquidConstants& liquid = *scene.materials[0].liquid;
  liquid = {is_tait ? 100 * speed * speed : 0, 0, 2 * spacing};
  scene.numerics.integrator =
      is_tait ? IntegratorId::velocity_verlet : IntegratorId::symplectic_euler;
  scene.numerics.control = StepControl::adaptive;
  return with_step(scene, step);
}

/// Particles that are too dense, over a run.
struct DensityError {
  Real mean = 0;  ///< over particles and times
  Real greatest = 0;
  int samples = 0;

  void add(const Diagnostics& now) {
    mean = (mean * samples + now.mean_density_error) / (samples + 1);
    greatest = std::max(greatest, now.max_density_error);
    ++samples;
  }
};

void add_density(Sheet& sheet, const DensityError& error, const std::string& of, const Run& run) {
  sheet.add("mean density error" + of, 5e-4, error.mean, at_most("tolerance of the solver"), run);
  sheet.add("greatest density error" + of, 0.02, error.greatest, at_most("target of the solver"),
            run);
}

// --- LIQ-3 ---

constexpr Real kDepth = 0.5;

/// Particles' heights and pressures, means over a second.
struct Profile {
  std::vector<Real> heights;
  std::vector<Real> pressures;
};

Profile observe_profile(Run& run, Real until, DensityError& density) {
  Profile mean;
  int samples = 0;
  run.observe_until(until, 0.02, [&] {
    density.add(run.diagnostics());
    const BodyView body = run.body();
    const std::vector<Real> now = run.simulation().liquid_fields(body.id).value().pressure;
    mean.heights.resize(now.size());
    mean.pressures.resize(now.size());
    for (std::size_t i = 0; i < now.size(); ++i) {
      mean.heights[i] += body.positions[i].z();
      mean.pressures[i] += now[i];
    }
    ++samples;
  });
  for (Real& height : mean.heights) height /= samples;
  for (Real& pressure : mean.pressures) pressure /= samples;
  return mean;
}

Real greatest_speed(const Run& run) {
  Real speed = 0;
  for (const Vec3& velocity : run.body().velocities) speed = std::max(speed, velocity.norm());
  return speed;
}

void check_column(Sheet& sheet, int layers) {
  const std::string of = ", " + std::to_string(layers) + " layers";
  const Real speed = std::sqrt(kGravity * kDepth);
  Run run = sheet.start(with_solver(load_scene("LIQ-3"), PressureSolver::incompressible,
                                    kDepth / layers, speed, 0.01));
  DensityError density;
  run.observe_until(3, 0.02, [&] { density.add(run.diagnostics()); });
  const Profile mean = observe_profile(run, 4, density);
  Real error = 0;
  Real scale = 0;
  for (std::size_t i = 0; i < mean.heights.size(); ++i) {
    const Real exact = 1000 * kGravity * (kDepth - mean.heights[i]);
    error += std::pow(mean.pressures[i] - exact, 2);
    scale += exact * exact;
  }
  sheet.add("relative L2 error of the pressure" + of, 0.06, std::sqrt(error / scale),
            at_most(kTarget), run);
  const Line line = fitted_line(mean.heights, mean.pressures, 0.1 * kDepth, 0.8 * kDepth);
  sheet.add("slope of the pressure / (-rho g)" + of, 1, -line.slope / (1000 * kGravity),
            within(0.02, kTarget), run);
  sheet.add("greatest speed / sqrt(g H)" + of, 0.05, greatest_speed(run) / speed,
            at_most("published target"), run);
  add_density(sheet, density, of, run);
}

void run_column(Sheet& sheet) {
  for (const int layers : {20, 40}) {
    if (!sheet.quick() || layers == 20) check_column(sheet, layers);
  }
}

// --- LIQ-15 ---

void check_dam_break(Sheet& sheet, PressureSolver solver, int layers) {
  constexpr Real kWidth = 0.2;
  const Real spacing = kWidth / layers;
  const Real speed = std::sqrt(2 * kGravity * 2 * kWidth);
  Run run = sheet.start(with_solver(load_scene("LIQ-15"), solver, spacing, speed, 0.005));
  DensityError density;
  const DamBreak seen = watch_dam_break(run, spacing, [&] { density.add(run.diagnostics()); });
  const std::string of =
      std::string(", ") + to_string(solver) + ", a/dx = " + std::to_string(layers);
  const bool is_tait = solver == PressureSolver::tait;
  const char* const target = "published target of weakly compressible liquids";
  sheet.add("RMS error of the front, best delay up to 0.35" + of, 0, best_front_error(seen.front),
            is_tait ? within(0.04, target) : within(0.03, kTarget), run);
  sheet.add("RMS error of the height at the back" + of, 0, height_error(seen.height),
            is_tait ? within(0.03, target) : within(0.026, kTarget), run);
  if (!is_tait) add_density(sheet, density, of, run);
}

void run_dam_break(Sheet& sheet) {
  for (const int layers : {20, 40}) {
    if (sheet.quick() && layers > 20) continue;
    check_dam_break(sheet, PressureSolver::tait, layers);
    check_dam_break(sheet, PressureSolver::incompressible, layers);
  }
}

// --- INT-1 ---

constexpr Real kRadius = 0.2;  // of the ball: four spacings [m]

/// A ball that starts where it should float, in a pool of which it displaces as much as it should.
Scene pool_with_ball(const std::string& ratio, Real draft) {
  Scene scene = with_solver(load_scene("INT-5"), PressureSolver::incompressible, 0.05, 0, 0.005);
  BodyDescription& ball = body_of(scene, "ball");
  ball.position.z() = 0.8 + kRadius * (1 - 2 * draft);
  ball.fixed = false;
  scene.materials[1].density = 1000 * std::stod(ratio);
  Scene pool = scene;
  pool.bodies.resize(1);
  const Run run(pool);
  const BodyView lattice = run.body();
  ParticleShape shape;
  for (std::size_t i = 0; i < lattice.positions.size(); ++i) {
    if ((lattice.positions[i] - ball.position).norm() < kRadius + 0.0125) continue;
    shape.positions.push_back(lattice.positions[i]);
    shape.masses.push_back(lattice.masses[i]);
  }
  scene.bodies[0].shape = shape;
  return scene;
}

void check_floating(Sheet& sheet, const std::string& ratio) {
  const Real exact = reference("/interaction/INT-1/sphere_draft_over_diameter/" + ratio);
  Run run = sheet.start(pool_with_ball(ratio, exact));
  run.advance_to(2);
  Real sum = 0;
  int samples = 0;
  run.observe_until(3, 0.02, [&] {
    const Diagnostics now = run.diagnostics();
    const Real level = (now.bodies[0].mass + now.bodies[1].mass) / (1000 * 0.8 * 0.8);
    sum += (level - now.bodies[1].center_of_mass.z() + kRadius) / (2 * kRadius);
    ++samples;
  });
  sheet.add("draft / diameter, density ratio " + ratio, exact, sum / samples, within(0.02, kTarget),
            run);
}

void run_floating(Sheet& sheet) {
  for (const char* ratio : {"0.25", "0.5", "0.75"}) {
    if (!sheet.quick() || ratio == std::string("0.5")) check_floating(sheet, ratio);
  }
}

}  // namespace

std::vector<Case> liquid_solver_cases() {
  return {{"LIQ-3i", "column of incompressible liquid", "liquid", {"LIQ-3"}, run_column},
          {"LIQ-15i", "dam break of incompressible liquid", "liquid", {"LIQ-15"}, run_dam_break},
          {"INT-1i",
           "ball that floats in incompressible liquid",
           "interaction",
           {"INT-5"},
           run_floating}};
}

}  // namespace vat::validation
