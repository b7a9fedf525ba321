#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "tests/validation/cases.h"

namespace vat::validation {
namespace {

/// A method of a run: an integrator, or implicit springs.
struct Way {
  const char* name;
  IntegratorId integrator;
  bool implicit;
};
constexpr Way kWays[] = {{"velocity_verlet", IntegratorId::velocity_verlet, false},
                         {"runge_kutta_4", IntegratorId::runge_kutta_4, false},
                         {"implicit springs", IntegratorId::velocity_verlet, true}};

Scene load_plastic(const std::string& name, const Way& way, Real step) {
  Scene scene = with_method(load_scene(name), way.integrator, step);
  for (Material& material : scene.materials) material.implicit_springs = way.implicit;
  return scene;
}

void set_gravity(Run& run, Real gravity) {
  if (!run.simulation().set_gravity({0, 0, -gravity})) throw std::logic_error("gravity refused");
}

/// Changes the weight of 1 kg [N] by 1 N per second, and waits until the motion has ended.
void load_slowly(Run& run, Real from, Real to) {
  constexpr Real kIncrement = 0.1;
  const int count = static_cast<int>(std::lround(std::abs(to - from) / kIncrement));
  for (int n = 1; n <= count; ++n) {
    set_gravity(run, from + n * (to - from) / count);
    run.advance_to(run.simulation().time() + 0.1);
  }
  run.advance_to(run.simulation().time() + 10);
}

// Under a load S with the elastic strain S / k, the plastic strain is p = (S / k -+ Y) / H if the
// spring yields in one direction, and unchanged otherwise.
void add_stress_strain(Sheet& sheet) {
  constexpr Real kStiffness = 1000;
  constexpr Real kYield = 0.01;
  constexpr Real kHardening = 0.2;
  for (const Way& way : kWays) {
    Scene scene = load_plastic("DEF-8", way, 1e-3);
    scene.materials[0].plasticity->hardening = kHardening;
    Run run = sheet.start(scene);
    Real last = 0;
    const Real flown = (20 / kStiffness - kYield) / kHardening;
    for (const auto& [weight, plastic] :
         {std::pair(5.0, 0.0), std::pair(20.0, flown), std::pair(0.0, flown),
          std::pair(-10.0, (-10 / kStiffness + kYield) / kHardening)}) {
      load_slowly(run, last, weight);
      last = weight;
      sheet.add("strain under " + std::to_string(static_cast<int>(weight)) + " N, " + way.name,
                weight / kStiffness + plastic, -1 - run.body().positions[1].z(),
                within(1e-6, "at rest to a thousandth of the load_plastic's last ten"), run);
    }
  }
}

// An impulse of energy m v^2 / 2: the spring stores k Y^2 / 2 elastically, and the rest becomes
// plastic at the force k Y.
void add_push(Sheet& sheet) {
  constexpr Real kSpeed = 1;
  constexpr Real kYield = 0.01;
  constexpr Real kStiffness = 1000;
  const Real set = (kSpeed * kSpeed / 2 - kStiffness * kYield * kYield / 2) / (kStiffness * kYield);
  for (const Way& way : kWays) {
    for (const Real step : {1e-4, 1e-5}) {
      Scene scene = load_plastic("DEF-8", way, step);
      scene.bodies[0].springs[0].constants.damping = 0;
      auto& shape = std::get<ParticleShape>(scene.bodies[0].shape);
      shape.velocities = {Vec3::Zero(), {0, 0, -kSpeed}};
      Run run = sheet.start(scene);
      Real least = 1;
      Real greatest = 0;
      run.advance_to(0.25);
      run.observe_until(0.75, step, [&] {
        const Real strain = -1 - run.body().positions[1].z();
        least = std::min(least, strain);
        greatest = std::max(greatest, strain);
      });
      const std::string method =
          std::string(", step ") + (step == 1e-4 ? "1e-4" : "1e-5") + ", " + way.name;
      // Within a step, the force exceeds k Y by up to k v dt, on average by half of that.
      const Real first_order = set * kSpeed * step / (2 * kYield);
      sheet.add("permanent strain of a push" + method, set, (least + greatest) / 2,
                within(first_order, "first order: v dt / 2 Y of it"), run);
      sheet.add("swing after it" + method, kYield, (greatest - least) / 2,
                within(first_order, "first order: v dt / 2 Y of it"), run);
    }
  }
}

void add_chain(Sheet& sheet) {
  constexpr Real kIncrement = 0.01;  // [m/s^2] every 20 ms
  for (const Way& way : kWays) {
    Run run = sheet.start(load_plastic("DEF-9", way, 1e-3));
    Real gravity = 0;
    while (run.diagnostics().torn_springs == 0 && gravity < 20) {
      gravity += kIncrement;
      set_gravity(run, gravity);
      run.advance_to(run.simulation().time() + 0.02);
    }
    // The first spring carries ten masses of 0.1 kg. It tears at k 0.1 l0 = 10 N.
    sheet.add(std::string("gravity at tearing [m/s2], ") + way.name, 10, gravity,
              within(3 * kIncrement, "steps of the load_plastic, which swings by as much again"),
              run);
    sheet.add(std::string("torn springs, ") + way.name, 1,
              static_cast<Real>(run.diagnostics().torn_springs), within(0, "the first alone"), run);
    const Real momentum = run.diagnostics().bodies[0].linear_momentum.z();
    run.advance_to(run.simulation().time() + 0.5);
    const Real gained = run.diagnostics().bodies[0].linear_momentum.z() - momentum;
    sheet.add(std::string("acceleration of the falling part [m/s2], ") + way.name, gravity,
              -gained / 0.5 / 1, within(1e-11, "free fall of 1 kg, round-off"), run);
  }
}

}  // namespace

std::vector<Case> plastic_spring_cases() {
  const std::string kind = "deformable";
  return {{"DEF-8",
           "weight on a plastic spring",
           kind,
           {"DEF-8"},
           [](Sheet& sheet) {
             add_stress_strain(sheet);
             add_push(sheet);
           }},
          {"DEF-9", "chain tearing under its weight", kind, {"DEF-9"}, add_chain}};
}

}  // namespace vat::validation
