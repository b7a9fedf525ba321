#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tests/validation/cases.h"
#include "tests/validation/order.h"
#include "tests/validation/reference.h"

namespace vat::validation {

namespace {

Real height(const Run& run) {
  return run.body().pose->center_of_mass.z();
}

void set_step(Scene& scene, Real step) {
  scene.numerics.step = step;
  scene.numerics.tick = step;
}

/// Contacts during a run in order of time. The gap is linear between steps.
struct Contacts {
  std::vector<Real> begins;  ///< [s]
  std::vector<Real> ends;    ///< [s]
  Real deepest = 0;          ///< maximum overlap [m]
};

/// Advances to `time` and records contacts of `gap` [m], which is negative in contact.
template <class Gap>
Contacts watch(Run& run, Real time, const Gap& gap) {
  Contacts seen;
  const Real step = run.simulation().step_size();
  Real before = gap();
  while (run.simulation().time() < time - step / 2) {
    const Real begin = run.simulation().time();
    run.advance_to(begin + step);
    const Real after = gap();
    const Real crossing = begin + step * before / (before - after);
    if (before > 0 && after <= 0) seen.begins.push_back(crossing);
    if (before <= 0 && after > 0) seen.ends.push_back(crossing);
    seen.deepest = std::max(seen.deepest, -after);
    before = after;
  }
  return seen;
}

// RIG-4.

void check_bounce(Sheet& sheet) {
  const std::string at = "/rigid/RIG-4a/";
  const Real omega = std::sqrt(reference(at + "k") / reference(at + "m"));
  Run run = sheet.start(load_scene("RIG-4"));
  const Real z = omega * run.simulation().step_size();
  const Tolerance tolerance = within_relative(z * z, "(omega dt)^2, order 2 in the contact");
  Real force = 0;
  const Contacts seen = watch(run, 1.5, [&] {
    const Real gap = height(run) - 0.05;
    if (gap < 0) force = std::max(force, run.diagnostics().bodies[0].outer_force.z());
    return gap;
  });
  sheet.add("time in contact [s]", reference(at + "contact_time"),
            seen.ends.at(0) - seen.begins.at(0), tolerance, run);
  sheet.add("greatest overlap [m]", reference(at + "max_penetration"), seen.deepest, tolerance,
            run);
  sheet.add("greatest force [N]", reference(at + "max_force"), force, tolerance, run);
  sheet.add("from bounce to bounce [s]", reference(at + "period_full"),
            seen.begins.at(1) - seen.begins.at(0), tolerance, run);
}

/// Returns the relative change of speed by a bounce: the worst of 16 phases of the step at contact.
Real worst_bounce(Sheet& sheet, Real step, Row& row) {
  Real worst = 0;
  for (int phase = 0; phase < 16; ++phase) {
    Scene scene = load_scene("RIG-4");
    set_step(scene, step);
    const Real fall = 1 + 4.43 * step * phase / 16;
    scene.bodies[0].position.z() = 0.05 + fall;
    Run run = sheet.start(scene);
    run.advance_to(step * std::ceil(0.7 / step));
    const Real speed = run.body().pose->velocity.z();
    const Real at_contact = std::sqrt(speed * speed + 2 * 9.81 * (height(run) - 0.05));
    worst = std::max(worst, std::abs(at_contact / std::sqrt(2 * 9.81 * fall) - 1));
    row.seconds += run.seconds();
    row.state_hash = run.state_hash();
  }
  return worst;
}

void check_bounce_energy(Sheet& sheet) {
  const std::string published = "/measured_yardsticks/bounce_RIG4_restitution_error/";
  const std::pair<const char*, Real> cases[] = {
      {"omega dt=0.5", 0.5}, {"0.2", 0.2}, {"0.1", 0.1}, {"0.05", 0.05}, {"0.01", 0.01}};
  for (const auto& [name, z] : cases) {
    Row row{.metric = "greatest |e - 1| of a bounce, omega dt = " +
                      std::string(name).substr(std::string(name).find('=') + 1),
            .reference = reference(published + name),
            .tolerance = at_most("same method elsewhere (reference.json)")};
    row.measured = worst_bounce(sheet, z / 100, row);
    sheet.add(row);
  }
}

void check_restitution(Sheet& sheet) {
  const std::string at = "/rigid/RIG-4b/restitution_vs_zeta/";
  for (const char* zeta : {"0.05", "0.1", "0.2", "0.5", "0.7"}) {
    Scene scene = load_scene("RIG-4");
    scene.gravity.setZero();
    scene.bodies[0].position.z() = 0.06;
    scene.bodies[0].velocity.z() = -1;
    const Real rate = 2 * std::stod(zeta) * 100;  // c / m
    scene.interfaces[0].constants.damping = rate;
    Run run = sheet.start(scene);
    run.advance_to(0.1);
    // The damping force starts with a jump within a step.
    sheet.add(std::string("restitution, damping ratio ") + zeta,
              reference(at + zeta + "/e_no_adhesion"), run.body().pose->velocity.z(),
              within(rate * run.simulation().step_size(), "one step of the damping, c dt/m"), run);
  }
}

void run_bounce(Sheet& sheet) {
  check_bounce(sheet);
  check_bounce_energy(sheet);
  check_restitution(sheet);
}

// RIG-5.

void check_collision(Sheet& sheet, const std::string& name) {
  const std::string at = "/rigid/" + name + "/";
  Scene scene = load_scene("RIG-5");
  std::array<Real, 2> masses{};
  for (std::size_t b = 0; b < 2; ++b) {
    const std::string index = std::to_string(b);
    masses[b] = reference(at + "m/" + index);
    std::get<ParticleShape>(scene.bodies[b].shape).masses = {masses[b]};
    scene.bodies[b].velocity.x() = reference(at + "v/" + index);
  }
  Run run = sheet.start(scene);
  const auto place = [&](const char* body) { return run.body(body).pose->center_of_mass.x(); };
  const Contacts seen = watch(run, 0.05, [&] { return place("second") - place("first") - 0.1; });
  const Real mu = masses[0] * masses[1] / (masses[0] + masses[1]);
  const Real z = std::sqrt(reference(at + "k") / mu) * run.simulation().step_size();
  const Tolerance tolerance = within_relative(z * z, "(omega dt)^2, order 2 in the contact");
  const std::string of = ", " + std::to_string(std::lround(masses[0])) + " kg on " +
                         std::to_string(std::lround(masses[1])) + " kg";
  sheet.add("time in contact [s]" + of, reference(at + "contact_time"),
            seen.ends.at(0) - seen.begins.at(0), tolerance, run);
  sheet.add("greatest overlap [m]" + of, reference(at + "max_overlap"), seen.deepest, tolerance,
            run);
  Real momentum = 0;
  for (std::size_t b = 0; b < 2; ++b) {
    const Real speed = run.simulation().bodies()[b].pose->velocity.x();
    momentum += masses[b] * speed;
    sheet.add(std::string(b == 0 ? "first" : "second") + " ball afterwards [m/s]" + of,
              reference(at + "v_out/" + std::to_string(b)), speed,
              within(z * z * 3, "(omega dt)^2 of the approach"), run);
  }
  sheet.add("momentum [kg m/s]" + of, reference(at + "momentum"), momentum,
            within(1e-13 * 2 * masses[0], "round-off"), run);
}

void run_collisions(Sheet& sheet) {
  for (const char* name : {"RIG-5a", "RIG-5b", "RIG-5c"}) check_collision(sheet, name);
}

// RIG-6.

constexpr int kStack = 5;

std::array<Real, kStack> overlaps(const Run& run) {
  std::array<Real, kStack> result{};
  Real below = -0.05;  // a floor acts at half of the distance between two balls
  for (int i = 0; i < kStack; ++i) {
    const Real z = run.simulation().bodies()[static_cast<std::size_t>(i)].pose->center_of_mass.z();
    result[static_cast<std::size_t>(i)] = 0.1 - (z - below);
    below = z;
  }
  return result;
}

void check_rest(Sheet& sheet) {
  Run run = sheet.start(load_scene("RIG-6"));
  run.advance_to(5);
  const std::array<Real, kStack> settled = overlaps(run);
  const Real end = sheet.quick() ? 10 : 65;
  run.advance_to(end);
  const std::array<Real, kStack> last = overlaps(run);
  Real creep = 0;
  for (std::size_t i = 0; i < kStack; ++i) {
    sheet.add("overlap under ball " + std::to_string(i + 1) + " [m]",
              reference("/rigid/RIG-6/overlap/" + std::to_string(i)), last[i],
              within_relative(1e-9, "statics, to round-off of positions of 0.5 m"), run);
    creep += std::abs(last[i] - settled[i]);
  }
  sheet.add("creep from 5 s on [m]", 0, creep, within(1e-6, "published target"), run);
  const Real scale = 2 * 9.81 * last[0];
  sheet.add("kinetic energy / (m g overlap)", 1e-6, run.diagnostics().kinetic_energy / scale,
            at_most("published target"), run);
}

/// The undamped stack, in its n-th mode with an amplitude of a thousandth of the smallest overlap.
Scene mode_of_stack(int n) {
  Scene scene = load_scene("RIG-6");
  scene.default_interface.damping = 0;
  Real settled = 0;
  for (int i = 0; i < kStack; ++i) {
    settled += reference("/rigid/RIG-6/overlap/" + std::to_string(i));
    const Real shape = std::sin((2 * n - 1) * (i + 1) * std::numbers::pi / (2 * kStack + 1));
    scene.bodies[static_cast<std::size_t>(i)].position.z() += 4e-7 * shape - settled;
  }
  return scene;
}

void check_modes(Sheet& sheet) {
  const Real settled = reference("/rigid/RIG-6/top_settlement");
  for (int n = 1; n <= kStack; ++n) {
    const Real omega = reference("/rigid/RIG-6/omega/" + std::to_string(n - 1));
    Run run = sheet.start(mode_of_stack(n));
    const Real step = run.simulation().step_size();
    const Real interval = step * std::round(0.5 / omega / step);
    std::vector<Real> samples;
    run.observe_until(interval * 250, interval, [&] {
      const auto top = run.simulation().bodies()[kStack - 1].pose->center_of_mass.z();
      samples.push_back(top - (0.45 - settled));
    });
    const Real z = omega * step;
    sheet.add("frequency of mode " + std::to_string(n) + " [rad/s]", omega,
              fitted_frequency(samples, interval),
              within_relative(z * z / 24 + 1e-6, "(omega dt)^2/24 of velocity Verlet, and the fit"),
              run);
  }
}

void run_contact_stack(Sheet& sheet) {
  check_rest(sheet);
  check_modes(sheet);
}

// RIG-8.

void run_eccentric(Sheet& sheet) {
  for (const char* stiffness : {"1000", "10000", "100000", "1000000"}) {
    Scene scene = load_scene("RIG-8");
    const Real k = std::stod(stiffness);
    scene.interfaces[0].constants.stiffness = k;
    set_step(scene, 1e-3 / std::sqrt(k));  // omega of one end is sqrt(k)
    Run run = sheet.start(scene);
    run.advance_to(run.simulation().step_size() * std::ceil(0.15 / run.simulation().step_size()));
    const std::string at = std::string("/rigid/RIG-8_dumbbell/finite_k_vcm_omega_tc/") + stiffness;
    // The ends are balls of 1 mm, with 1.6e-6 of the dumbbell's inertia.
    const Tolerance tolerance =
        within(1e-5, "inertia of the ends, 2e-6, and (omega dt)^2, a few times 1e-6");
    sheet.add(std::string("speed of the centre afterwards [m/s], k = ") + stiffness,
              reference(at + "/0"), run.body().pose->velocity.z(), tolerance, run);
    sheet.add(std::string("angular velocity afterwards [rad/s], k = ") + stiffness,
              reference(at + "/1"), run.body().pose->angular_velocity.y(), tolerance, run);
    sheet.add(std::string("kinetic energy afterwards [J], k = ") + stiffness,
              reference("/rigid/RIG-8_dumbbell/energy_out"), run.diagnostics().kinetic_energy,
              tolerance, run);
  }
}

}  // namespace

std::vector<Case> rigid_contact_cases() {
  return {{"RIG-4", "ball bouncing on a floor", "rigid", {"RIG-4"}, run_bounce},
          {"RIG-5", "collision of two balls", "rigid", {"RIG-5"}, run_collisions},
          {"RIG-6", "stack of balls at rest", "rigid", {"RIG-6"}, run_contact_stack},
          {"RIG-8", "eccentric impact of a dumbbell", "rigid", {"RIG-8"}, run_eccentric}};
}

}  // namespace vat::validation
