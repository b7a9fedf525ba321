#include "tests/validation/cases/liquid/liquid_solvers.h"

#include <algorithm>
#include <cmath>

#include "tests/validation/cases.h"
#include "tests/validation/cases/liquid/liquid_fit.h"
#include "tests/validation/cases/liquid/liquid_rest.h"
#include "tests/validation/cases/liquid/pool.h"
#include "tests/validation/reference.h"

// Incompressible and weakly compressible liquids: their errors and run times.

namespace vat::validation {

namespace {

const char* const kTarget = "twice the error that a weakly compressible liquid may have";

/// Returns the scene with its liquid at rest density, this solver, and adaptive steps of at most
/// `step`. `speed` is the expected maximum [m/s].
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

void add_density(Sheet& sheet, const std::string& of, const SolverRun& result) {
  sheet.add("mean density error" + of, 5e-4, result.density.mean,
            at_most("tolerance of the solver"), result.run);
  sheet.add("greatest density error" + of, 0.02, result.density.greatest,
            at_most("target of the solver"), result.run);
}

// LIQ-3.

constexpr Real kSolverDepth = 0.5;

/// Returns the scene of the weakly compressible column, with settling. For the incompressible
/// liquid, the artificial viscosity becomes a physical one, since that liquid has no speed of
/// sound.
Scene make_column(PressureSolver solver, Real spacing) {
  Scene scene = load_scene("LIQ-3-tait");
  if (solver == PressureSolver::tait) {
    set_spacing(scene, spacing);
    return with_step(scene, acoustic_step(scene, 0.02));
  }
  const LiquidConstants calmed = *scene.materials[0].liquid;
  scene = with_solver(scene, solver, spacing, 0, 0.01);
  scene.materials[0].liquid->viscosity = calmed.artificial_viscosity * 1000 *
                                         std::sqrt(calmed.stiffness) * calmed.support_radius /
                                         (4 * (scene.dimensions + 2));
  return scene;
}

StartRun starter_of(Sheet& sheet) {
  return [&sheet](const Scene& scene) { return sheet.start(scene); };
}

void check_solver_column(Sheet& sheet, int layers) {
  const std::string of = ", " + std::to_string(layers) + " layers";
  const ColumnRun column = run_column(PressureSolver::incompressible, layers, starter_of(sheet));
  sheet.add("relative L2 error of the pressure" + of, 0.06, column.pressure_error(),
            at_most(kTarget), column.run);
  const Line line =
      fitted_line(column.heights, column.pressures, 0.1 * kSolverDepth, 0.8 * kSolverDepth);
  sheet.add("slope of the pressure / (-rho g)" + of, 1, -line.slope / (1000 * kGravity),
            within(0.02, kTarget), column.run);
  sheet.add("greatest speed / sqrt(g H)" + of, 8e-3, column.residual_speed(), at_most(kTarget),
            column.run);
  add_density(sheet, of, column);
}

void check_columns(Sheet& sheet) {
  for (const int layers : {20, 40}) {
    if (!sheet.quick() || layers == 20) check_solver_column(sheet, layers);
  }
}

// LIQ-15.

void check_dam_break(Sheet& sheet, PressureSolver solver, int layers) {
  const DamBreakRun result = run_dam_break(solver, layers, starter_of(sheet));
  const std::string of =
      std::string(", ") + to_string(solver) + ", a/dx = " + std::to_string(layers);
  const bool is_tait = solver == PressureSolver::tait;
  const char* const target = "published target of weakly compressible liquids";
  sheet.add("RMS error of the front, best delay up to 0.35" + of, 0,
            best_front_error(result.seen.front),
            is_tait ? within(0.04, target) : within(0.03, kTarget), result.run);
  sheet.add("RMS error of the height at the back" + of, 0, height_error(result.seen.height),
            is_tait ? within(0.03, target) : within(0.026, kTarget), result.run);
  if (!is_tait) add_density(sheet, of, result);
}

void check_dam_breaks(Sheet& sheet) {
  for (const int layers : {20, 40}) {
    if (sheet.quick() && layers > 20) continue;
    check_dam_break(sheet, PressureSolver::tait, layers);
    check_dam_break(sheet, PressureSolver::incompressible, layers);
  }
}

// INT-1.

constexpr Real kSolverRadius = 0.2;  // of the ball: four spacings [m]

/// A ball at its equilibrium in a pool that already contains the displaced volume.
Scene solver_pool_with_ball(const std::string& ratio, Real draft) {
  Scene scene = with_solver(load_scene("INT-5"), PressureSolver::incompressible, 0.05, 0, 0.005);
  BodyDescription& ball = body_of(scene, "ball");
  ball.position.z() = 0.8 + kSolverRadius * (1 - 2 * draft);
  ball.fixed = false;
  scene.materials[1].density = 1000 * std::stod(ratio);
  clear_around_ball(scene, kSolverRadius + 0.0125);
  return scene;
}

void check_solver_floating(Sheet& sheet, const std::string& ratio) {
  const Real exact = reference("/interaction/INT-1/sphere_draft_over_diameter/" + ratio);
  Run run = sheet.start(solver_pool_with_ball(ratio, exact));
  run.advance_to(2);
  Real sum = 0;
  int samples = 0;
  run.observe_until(3, 0.02, [&] {
    const Diagnostics now = run.diagnostics();
    const Real level = (now.bodies[0].mass + now.bodies[1].mass) / (1000 * 0.8 * 0.8);
    sum += (level - now.bodies[1].center_of_mass.z() + kSolverRadius) / (2 * kSolverRadius);
    ++samples;
  });
  sheet.add("draft / diameter, density ratio " + ratio, exact, sum / samples, within(0.02, kTarget),
            run);
}

void run_solver_floating(Sheet& sheet) {
  for (const char* ratio : {"0.25", "0.5", "0.75"}) {
    if (!sheet.quick() || ratio == std::string("0.5")) check_solver_floating(sheet, ratio);
  }
}

}  // namespace

void DensityError::add(const Diagnostics& now) {
  mean = (mean * samples + now.mean_density_error) / (samples + 1);
  greatest = std::max(greatest, now.max_density_error);
  ++samples;
}

DamBreakRun run_dam_break(PressureSolver solver, int layers, const StartRun& start) {
  constexpr Real kWidth = 0.2;
  const Real spacing = kWidth / layers;
  const Real speed = std::sqrt(2 * kGravity * 2 * kWidth);
  DamBreakRun result{{start(with_solver(load_scene("LIQ-15"), solver, spacing, speed, 0.005)), {}},
                     {}};
  result.seen =
      watch_dam_break(result.run, spacing, [&] { result.density.add(result.run.diagnostics()); });
  return result;
}

ColumnRun run_column(PressureSolver solver, int layers, const StartRun& start) {
  ColumnRun column{{start(make_column(solver, kSolverDepth / layers)), {}}, {}, {}};
  Run& run = column.run;
  run.advance_to(0.02);  // the first step separates particles that are too close
  run.observe_until(2, 0.02, [&] { column.density.add(run.diagnostics()); });
  const std::size_t count = run.body().positions.size();
  column.heights.assign(count, 0);
  column.pressures.assign(count, 0);
  int samples = 0;
  run.observe_until(3, 0.02, [&] {
    column.density.add(run.diagnostics());
    const BodyView body = run.body();
    const std::vector<Real> now = run.simulation().liquid_fields(body.id).value().pressure;
    for (std::size_t i = 0; i < count; ++i) {
      column.heights[i] += body.positions[i].z();
      column.pressures[i] += now[i];
    }
    ++samples;
  });
  for (Real& height : column.heights) height /= samples;
  for (Real& pressure : column.pressures) pressure /= samples;
  return column;
}

Real ColumnRun::pressure_error() const {
  Real error = 0;
  Real scale = 0;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const Real exact = 1000 * kGravity * (kSolverDepth - heights[i]);
    error += std::pow(pressures[i] - exact, 2);
    scale += exact * exact;
  }
  return std::sqrt(error / scale);
}

Real ColumnRun::residual_speed() const {
  Real speed = 0;
  for (const Vec3& velocity : run.body().velocities) speed = std::max(speed, velocity.norm());
  return speed / std::sqrt(kGravity * kSolverDepth);
}

std::vector<Case> liquid_solver_cases() {
  return {{"LIQ-3i", "column of incompressible liquid", "liquid", {"LIQ-3-tait"}, check_columns},
          {"LIQ-15i", "dam break of incompressible liquid", "liquid", {"LIQ-15"}, check_dam_breaks},
          {"INT-1i",
           "ball floating in incompressible liquid",
           "interaction",
           {"INT-5"},
           run_solver_floating}};
}

}  // namespace vat::validation
