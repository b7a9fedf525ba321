#include <cmath>
#include <numbers>

#include "tests/validation/cases.h"
#include "tests/validation/cases/liquid/liquid_rest.h"
#include "tests/validation/cases/liquid/pool.h"
#include "tests/validation/reference.h"

// Bodies in a weakly compressible liquid.

namespace vat::validation {

namespace {

constexpr Real kTaitRadius = 0.1;  // ball radius: four spacings [m]
constexpr Real kTaitVolume = 4 * std::numbers::pi / 3 * kTaitRadius * kTaitRadius * kTaitRadius;
constexpr const char* kTaitAsked = "asked of a liquid that is to float bodies right";

struct TaitPool {
  Real width = 0.5;  ///< [m]
  Real depth = 0;    ///< [m]

  /// Returns the point on the axis at a height.
  Vec3 at(Real height) const { return {width / 2, width / 2, height}; }
};

/// Returns a narrow pool for a quick run. A ball at rest is not affected by the walls.
TaitPool pool_at_rest(Sheet& sheet, Real depth) {
  return {sheet.quick() ? 0.35 : 0.5, depth};
}

/// A scene with this pool and a ball of this density ratio, centred at `center`.
Scene tait_pool_with_ball(const TaitPool& pool, Real density_ratio, const Vec3& center) {
  const Real depth = pool.depth;
  Scene scene = load_scene("INT-5-tait");
  const Real c2 = 100 * kGravity * depth;  // ten times the speed of a long wave
  scene.materials[0].liquid->stiffness = c2;
  scene.materials[1].density = 1000 * density_ratio;
  scene.settling->drag = std::sqrt(c2) / depth;
  BoxShape& box = std::get<BoxShape>(scene.bodies[0].shape);
  box.center = pool.at(depth / 2);
  box.size = {pool.width, pool.width, depth};
  scene.vat->max = {pool.width, pool.width, 2};
  scene.bodies[1].position = center;
  clear_around_ball(scene, kTaitRadius + scene.bodies[0].spacing / 2);
  return with_step(scene, acoustic_step(scene, 0.02));
}

void free_ball(Scene& scene, Real release) {
  scene.bodies[1].fixed = false;
  scene.bodies[1].release = release;
}

// INT-5.

/// Returns the digits of i in a base, mirrored at the point, minus a half: positions evenly
/// distributed over -0.5..0.5.
Real spread(int i, int base) {
  Real sum = -0.5;
  for (Real part = 1.0 / base; i > 0; i /= base, part /= base) sum += part * (i % base);
  return sum;
}

/// Returns the mean upward force on the ball over 0.3 s, divided by rho g V.
Real buoyancy(Run& run) {
  run.advance_to(0.9);
  Real sum = 0;
  int samples = 0;
  run.observe_until(1.2, 0.02, [&] {
    sum += run.diagnostics().bodies[1].outer_force.z();
    ++samples;
  });
  return sum / samples / (1000 * kGravity * kTaitVolume);
}

void run_tait_held(Sheet& sheet) {
  // The position of the ball in the lattice changes the result by one percent. The mean over
  // positions is compared.
  const int places = sheet.quick() ? 2 : 8;
  Row row{.metric = "buoyant force / (rho g V), mean of " + std::to_string(places) + " positions",
          .reference = 1,
          .tolerance = within(0.015, kTaitAsked)};
  for (int i = 1; i <= places; ++i) {
    const Vec3 offset(spread(i, 2), spread(i, 3), spread(i, 5));
    const TaitPool pool = pool_at_rest(sheet, 0.45);
    Run run = sheet.start(tait_pool_with_ball(pool, 1, pool.at(0.225) + 0.025 * offset));
    row.measured += buoyancy(run) / places;
    row.seconds += run.seconds();
    row.state_hash = run.state_hash();
  }
  sheet.add(row);
}

// INT-8.

void run_dam(Sheet& sheet) {
  Scene scene = load_scene("INT-8-tait");
  Run run = sheet.start(with_step(scene, acoustic_step(scene, 0.02)));
  run.advance_to(1);
  Real sum = 0;
  int samples = 0;
  run.observe_until(sheet.quick() ? 1.2 : 2, 0.02, [&] {
    sum += run.diagnostics().bodies[1].outer_force.x();
    ++samples;
  });
  sheet.add("force on the wall, 0.3 m wide [N]", reference("/interaction/INT-8/force"),
            0.3 * sum / samples,
            within_relative(0.02, "a hundredth each for the pressure's level and slope"), run);
}

// INT-1.

Real exact_draft(const char* ratio) {
  return reference(std::string("/interaction/INT-1/sphere_draft_over_diameter/") + ratio);
}

/// A pool and a ball of this density ratio, one spacing above its equilibrium.
Scene pool_with_floating_ball(const TaitPool& pool, const char* ratio) {
  const Real height = pool.depth + kTaitRadius * (1 - 2 * exact_draft(ratio)) + 0.025;
  return tait_pool_with_ball(pool, std::stod(ratio), pool.at(height));
}

void add_draft(Sheet& sheet, const char* ratio, const Scene& scene, Real tolerance) {
  const Real area = scene.vat->max.x() * scene.vat->max.y();
  Run run = sheet.start(scene);
  run.advance_to(sheet.quick() ? 1 : 2);
  Real sum = 0;
  int samples = 0;
  run.observe_until(sheet.quick() ? 1.2 : 3, 0.02, [&] {
    sum += draft(run, kTaitRadius, area);
    ++samples;
  });
  sheet.add(std::string("draft / diameter, density ratio ") + ratio, exact_draft(ratio),
            sum / samples, within(tolerance, kTaitAsked), run);
}

void run_tait_floating(Sheet& sheet) {
  for (const char* ratio : {"0.25", "0.5", "0.75"}) {
    if (sheet.quick() && ratio != std::string("0.5")) continue;
    Scene scene = pool_with_floating_ball(pool_at_rest(sheet, 0.35), ratio);
    free_ball(scene, 0.6);
    add_draft(sheet, ratio, scene, 0.01);
  }
}

/// Makes the ball a lattice of springs. The pressure of the liquid, at most rho g 2R, strains it by
/// 2R rho g dx/k = 3 %. Forces along the diagonals reduce that.
void make_soft(Scene& scene) {
  const SpringConstants spring{2000, 2};
  scene.bodies[1].kind = BodyKind::deformable;
  scene.bodies[1].fixed = false;
  scene.materials[1].springs = LatticeSprings{spring, spring, spring};
  scene.numerics.step /= 3;  // the springs are faster than sound
}

void run_soft_floating(Sheet& sheet) {
  for (const char* ratio : {"0.25", "0.5", "0.75"}) {
    if (sheet.quick() && ratio != std::string("0.5")) continue;
    Scene scene = pool_with_floating_ball(pool_at_rest(sheet, 0.35), ratio);
    make_soft(scene);
    add_draft(sheet, ratio, scene, 0.02);
  }
}

// INT-3.

/// Returns the downward acceleration in a spherical shell of liquid as wide as the pool.
Real release_acceleration(const TaitPool& pool, Real ratio) {
  const Real b3 = std::pow(pool.width / 2 / kTaitRadius, 3);
  const Real added_mass = 0.5 * (b3 + 2) / (b3 - 1);
  return (ratio - 1) / (ratio + added_mass) * kGravity;
}

void check_tait_release(Sheet& sheet, const char* ratio) {
  constexpr Real kRelease = 0.6;
  const TaitPool pool{.depth = 0.5};
  Scene scene = tait_pool_with_ball(pool, std::stod(ratio), pool.at(0.25));
  scene.settling->until = 0.4;
  // The theory applies to a liquid without viscosity.
  scene.materials[0].liquid->viscosity = 0;
  scene.materials[0].liquid->artificial_viscosity = 0.005;
  free_ball(scene, kRelease);
  Run run = sheet.start(scene);
  run.advance_to(kRelease);
  Real sum_tv = 0;
  Real sum_tt = 0;
  // Ends before drag and the floor matter: the ball moves by at most an eighth of its radius.
  run.observe_until(kRelease + 0.06, 0.02, [&] {
    const Real t = run.simulation().time() - kRelease;
    sum_tv -= t * run.body("ball").pose->velocity.z();
    sum_tt += t * t;
  });
  sheet.add(std::string("acceleration downwards after release [m/s2], density ratio ") + ratio,
            release_acceleration(pool, std::stod(ratio)), sum_tv / sum_tt,
            within_relative(0.05, kTaitAsked), run);
}

void run_tait_release(Sheet& sheet) {
  for (const char* ratio : {"0.5", "2", "4"}) {
    if (sheet.quick() && ratio != std::string("2")) continue;
    check_tait_release(sheet, ratio);
  }
}

// A ball on the floor.

void run_sinking(Sheet& sheet) {
  const TaitPool pool = pool_at_rest(sheet, 0.35);
  Scene scene = tait_pool_with_ball(pool, 1.5, pool.at(0.2));
  free_ball(scene, 0.6);
  Run run = sheet.start(scene);
  run.advance_to(sheet.quick() ? 2 : 4);
  // Weight minus buoyancy, on one spring of the lowest layer of particles.
  const Real sink = 500 * kTaitVolume * kGravity / scene.interfaces[0].constants.stiffness;
  const RigidPose pose = *run.body("ball").pose;
  sheet.add("height of the centre on the floor / radius", 1, pose.center_of_mass.z() / kTaitRadius,
            within(sink / kTaitRadius, "at most the load on one spring of the floor"), run);
  sheet.add("speed on the floor / sqrt(g H)", 4e-3,
            pose.velocity.norm() / std::sqrt(kGravity * pool.depth),
            at_most("the residual speed of a liquid at rest"), run);
}

}  // namespace

std::vector<Case> tait_body_cases() {
  return {{"INT-1-tait",
           "ball floating in a weakly compressible liquid",
           "interaction",
           {"INT-5-tait"},
           run_tait_floating},
          {"INT-1-soft",
           "ball of springs floating in a weakly compressible liquid",
           "interaction",
           {"INT-5-tait"},
           run_soft_floating},
          {"INT-1-sunk",
           "ball sinking to the floor in a weakly compressible liquid",
           "interaction",
           {"INT-5-tait"},
           run_sinking},
          {"INT-3-tait",
           "ball released in a weakly compressible liquid",
           "interaction",
           {"INT-5-tait"},
           run_tait_release},
          {"INT-5-tait",
           "buoyancy of a held ball in a weakly compressible liquid",
           "interaction",
           {"INT-5-tait"},
           run_tait_held},
          {"INT-8-tait",
           "force of a weakly compressible liquid on a dam",
           "interaction",
           {"INT-8-tait"},
           run_dam}};
}

}  // namespace vat::validation
