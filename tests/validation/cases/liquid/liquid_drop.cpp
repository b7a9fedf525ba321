#include <algorithm>
#include <cmath>
#include <functional>

#include "tests/validation/cases.h"
#include "tests/validation/cases/liquid/liquid_rest.h"
#include "tests/validation/order.h"
#include "tests/validation/reference.h"

namespace vat::validation {

namespace {

constexpr const char* kNoEnergy =
    "the kernels of density (poly6) and force (spiky) do not derive from one energy";
const std::string kElsewhere = "same method elsewhere, spacing R/";
const std::string kDropAsked = "error of the best explicit solvers";

/// Returns the semi-axes of the ellipse or ellipsoid with the body's second moments [m].
Vec3 semi_axes(const Run& run) {
  const BodyView body = run.body();
  Vec3 moments = Vec3::Zero();
  for (const Vec3& x : body.positions) moments += x.cwiseAbs2();
  const int dimensions = run.simulation().scene().dimensions;
  return ((dimensions + 2) / static_cast<Real>(body.positions.size()) * moments).cwiseSqrt();
}

/// Returns the axes relative to the start. The moments of a lattice cut to a ball differ slightly
/// from the moments of the ball.
Vec3 stretch_at(Run& run, const Vec3& start, Real time) {
  run.advance_to(time);
  return semi_axes(run).cwiseQuotient(start);
}

Real momentum_error(const Run& run) {
  const BodyView body = run.body();
  Real scale = 0;
  for (std::size_t i = 0; i < body.masses.size(); ++i) {
    scale += body.masses[i] * body.velocities[i].norm();
  }
  return run.diagnostics().bodies[0].linear_momentum.norm() / scale;
}

void add_momentum(Sheet& sheet, const Run& run, const std::string& of = "") {
  sheet.add("momentum / sum m|v|" + of, 0, momentum_error(run), within(1e-12, "round-off"), run);
}

// LIQ-9a.

/// Permitted distances from theory.
struct EllipseTolerances {
  Tolerance long_axis;
  Tolerance short_axis;
  Tolerance energy;
};

void check_elliptic(Sheet& sheet, Scene scene, const EllipseTolerances& tolerances,
                    const std::string& of = "") {
  set_rest_mass(scene);
  Run run = sheet.start(scene);
  const Vec3 start = semi_axes(run);
  const Real energy = run.diagnostics().kinetic_energy;
  const std::string at = "/liquid/LIQ-9a/state/0.0076/";
  const Vec3 axes = stretch_at(run, start, 0.0076);
  sheet.add("long axis at 0.0076 s [m]" + of, reference(at + "b"), axes.z(), tolerances.long_axis,
            run);
  sheet.add("short axis at 0.0076 s [m]" + of, reference(at + "a"), axes.x(), tolerances.short_axis,
            run);
  sheet.add("kinetic energy / initial energy" + of, 1, run.diagnostics().kinetic_energy / energy,
            tolerances.energy, run);
  add_momentum(sheet, run, of);
}

const std::string kEllipse = "/measured_yardsticks/elliptic_drop_2d_t0p0076/";

void run_elliptic(Sheet& sheet) {
  const std::string published = kEllipse + "mcg03 corrected R~1dx=25/";
  check_elliptic(sheet, load_scene("LIQ-9a"),
                 {within_relative(std::abs(reference(published + "b_rel")), kElsewhere + "25"),
                  within_relative(reference(kEllipse + "wcsph R~1dx=25/a_rel"),
                                  "the best explicit method elsewhere, spacing R/25"),
                  within(1 - reference(published + "E"), kElsewhere + "25")});
}

void run_tait_elliptic(Sheet& sheet) {
  const std::string published = kEllipse + "wcsph R~1dx=50/";
  const EllipseTolerances tolerances = {
      within_relative(0.002, kDropAsked),
      within_relative(reference(published + "a_rel"), kElsewhere + "50"),
      within(1 - reference(published + "E"), kElsewhere + "50")};
  Scene scene = load_scene("LIQ-9a-tait");
  scene.pair_precision =
      PairPrecision::double_precision;  // to conserve momentum to the last digits
  check_elliptic(sheet, scene, tolerances);
  scene.kernel = KernelId::cubic_spline;
  check_elliptic(sheet, scene, tolerances, ", cubic spline");
}

// LIQ-9b.

/// Returns the relative error of the long axis after a second. The radius has `layers` particles.
Real ellipsoid_error(Sheet& sheet, int layers, Row& row) {
  Scene scene = load_scene("LIQ-9b");
  set_spacing(scene, 1.0 / layers);
  scene.materials[0].liquid->viscosity = 1000 * artificial_viscosity(scene, 0.005);
  Run run = sheet.start(with_step(scene, acoustic_step(scene, 0.05)));
  const Vec3 start = semi_axes(run);
  const Real exact = reference("/liquid/LIQ-9b/semi_axes/1.0/c");
  const Real error = std::abs(stretch_at(run, start, 1).z() / exact - 1);
  row.seconds += run.seconds();
  row.state_hash = run.state_hash();
  return error;
}

void run_ellipsoid(Sheet& sheet) {
  const int layers = sheet.quick() ? 8 : 12;
  if (!sheet.quick()) {
    Scene scene = load_scene("LIQ-9b");
    set_rest_mass(scene);
    Run run = sheet.start(scene);
    const Vec3 start = semi_axes(run);
    for (const char* time : {"0.1", "0.25", "0.5", "1.0"}) {
      const std::string at = std::string("/liquid/LIQ-9b/semi_axes/") + time;
      const Vec3 axes = stretch_at(run, start, std::stod(time));
      sheet.add(std::string("long axis at ") + time + " s [m]", reference(at + "/c"), axes.z(),
                within_relative(0.013, kElsewhere + "12"), run);
      sheet.add(std::string("short axis at ") + time + " s [m]", reference(at + "/a"), axes.x(),
                within_relative(0.069, kElsewhere + "12"), run);
    }
    add_momentum(sheet, run);
  }
  Row row{.metric = "order of convergence of the long axis in the spacing",
          .reference = 1,
          .tolerance = at_least("a surface whose place is known to a part of a spacing")};
  std::vector<Real> spacings;
  std::vector<Real> errors;
  for (const int n : {layers / 2, 3 * layers / 4, layers}) {
    spacings.push_back(1.0 / n);
    errors.push_back(ellipsoid_error(sheet, n, row));
  }
  row.measured = observed_order(spacings, errors);
  sheet.add(row);
}

// LIQ-9c, LIQ-9d.

/// Returns the mean period [s] of the next `count` periods, from the times at which the x and z
/// axes are equal. Calls `watch` after every step.
Real mean_period(
    Run& run, int count, const std::function<void()>& watch = [] {}) {
  std::vector<Real> zeros;
  Real before = 0;
  const Real step = run.simulation().step_size();
  const auto difference = [&] {
    const Vec3 axes = semi_axes(run);
    return axes.z() - axes.x();
  };
  while (zeros.size() < 2 * static_cast<std::size_t>(count)) {
    const Real begin = run.simulation().time();
    run.advance_to(begin + step);
    watch();
    const Real after = difference();
    if (before * after < 0) zeros.push_back(begin + step * before / (before - after));
    before = after;
  }
  return zeros.back() / count;
}

/// The work against the field counts as potential energy.
void add_swing(Sheet& sheet, Scene scene, const std::string& at, int periods) {
  set_rest_mass(scene);
  const std::string of = ", " + std::to_string(periods) + " periods";
  Run run = sheet.start(with_step(scene, acoustic_step(scene, 0.01)));
  const Real energy = run.energy();
  sheet.add("period [s]" + of, reference(at + "period"), mean_period(run, periods),
            within_relative(0.02, "same method elsewhere (LIQ-9c)"), run);
  sheet.add("energy / initial energy" + of, 0.95, run.energy() / energy,
            within(0.05, "published target, 0.9 to 1"), run);
}

void run_swing_in_plane(Sheet& sheet) {
  add_swing(sheet, load_scene("LIQ-9c"), "/liquid/LIQ-9c/", sheet.quick() ? 2 : 5);
  if (sheet.quick()) return;
  Scene wide = load_scene("LIQ-9c");
  wide.materials[0].liquid->support_radius = 3 * wide.bodies[0].spacing;
  set_rest_mass(wide);
  Run run = sheet.start(with_step(wide, acoustic_step(wide, 0.01)));
  const Real energy = run.energy();
  run.advance_to(18.75);
  sheet.add("energy / initial energy, H/dx = 3, 5 periods", 1, run.energy() / energy,
            reported(kNoEnergy), run);
}

void run_tait_swing(Sheet& sheet) {
  Scene scene = load_scene("LIQ-9c-tait");
  const int periods = sheet.quick() ? 1 : 5;
  if (sheet.quick()) set_spacing(scene, 2 * scene.bodies[0].spacing);
  const std::string of = ", " + std::to_string(periods) + " periods";
  Run run = sheet.start(with_step(scene, acoustic_step(scene, 0.01)));
  const Real energy = run.energy();
  Real greatest = 0;
  const Real period =
      mean_period(run, periods, [&] { greatest = std::max(greatest, run.energy()); });
  sheet.add("period [s]" + of, reference("/liquid/LIQ-9c/period"), period,
            within_relative(0.002, kDropAsked), run);
  sheet.add("greatest energy / initial energy" + of, 1, greatest / energy,
            at_most("nothing does work on the drop"), run);
  sheet.add("energy / initial energy" + of, 0.93, run.energy() / energy, at_least(kDropAsked), run);
}

void run_swing(Sheet& sheet) {
  add_swing(sheet, load_scene("LIQ-9d"), "/liquid/LIQ-9d/", 2);
}

// LIQ-10.

void run_patch(Sheet& sheet) {
  Scene scene = load_scene("LIQ-10");
  set_rest_mass(scene);
  Run run = sheet.start(with_step(scene, acoustic_step(scene, 0.01)));
  const Diagnostics start = run.diagnostics();
  const Real mass = start.bodies[0].mass;
  // The area follows from the particles' mass. The spin is 1 rad/s, the side 1 m.
  sheet.add(
      "initial angular momentum [kg m2/s]", mass / 6, start.bodies[0].angular_momentum.y(),
      within_relative(std::pow(scene.bodies[0].spacing, 2) * 1.01, "dx^2 of the midpoint rule"),
      run);
  run.advance_to(2);
  const Diagnostics end = run.diagnostics();
  sheet.add("angular momentum after 2 s / initial angular momentum", 1,
            end.bodies[0].angular_momentum.y() / start.bodies[0].angular_momentum.y(),
            within(1e-10, "central forces, no viscosity"), run);
  sheet.add(
      "kinetic energy after 2 s / initial kinetic energy", 1,
      end.kinetic_energy / start.kinetic_energy,
      reported("the pressure of the patch is negative, and the method has no negative pressure"),
      run);
  add_momentum(sheet, run);
}

}  // namespace

std::vector<Case> liquid_drop_cases() {
  return {
      {"LIQ-9a", "drop stretched to an ellipse", "liquid", {"LIQ-9a"}, run_elliptic},
      {"LIQ-9a-tait",
       "weakly compressible drop stretched to an ellipse",
       "liquid",
       {"LIQ-9a-tait"},
       run_tait_elliptic},
      {"LIQ-9b", "drop stretched to an ellipsoid", "liquid", {"LIQ-9b"}, run_ellipsoid},
      {"LIQ-9c", "oscillating drop in two dimensions", "liquid", {"LIQ-9c"}, run_swing_in_plane},
      {"LIQ-9c-tait",
       "oscillating weakly compressible drop in two dimensions",
       "liquid",
       {"LIQ-9c-tait"},
       run_tait_swing},
      {"LIQ-9d", "oscillating drop", "liquid", {"LIQ-9d"}, run_swing},
      {"LIQ-10", "rotating square patch", "liquid", {"LIQ-10"}, run_patch}};
}

}  // namespace vat::validation
