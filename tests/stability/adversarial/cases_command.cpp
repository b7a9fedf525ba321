#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "core/limits.h"
#include "tests/stability/adversarial/cases.h"
#include "tests/stability/builders.h"

namespace vat::stability {
namespace {

using Command = std::function<void(Simulation&, std::uint32_t)>;

Scene make_crowded_tank() {
  Scene scene = make_tank();
  // A grab accelerates half the tank by up to 200 m/s^2.
  for (auto& interface : scene.interfaces) interface.constants.stiffness = 1e5;
  scene.bodies = {make_block("pool", BodyKind::liquid, 5, {0.5, 0.5, 0.14}),
                  make_block("jelly", BodyKind::deformable, 3, {0.4, 0.5, 0.34}),
                  make_block("cube", BodyKind::rigid, 3, {0.6, 0.5, 0.34})};
  return scene;
}

void add_case(Cases& cases, const std::string& name, Expected expected, Command command) {
  cases.push_back({.group = name,
                   .name = name,
                   .scene = make_crowded_tank(),
                   .expected = expected,
                   .command = std::move(command)});
}

/// Throws if a command fails, so that its case cannot pass without it.
void require(const Status& status) {
  if (!status) throw std::runtime_error(status.errors().front().message);
}

void add_bodies(Cases& cases) {
  for (const BodyKind kind : kKinds) {
    add_case(
        cases, std::string("adds into contact, removes: ") + to_string(kind), Expected::runs,
        [kind](Simulation& simulation, std::uint32_t tick) {
          if (tick % 2 == 0) {
            const auto added = simulation.add_body(make_block("new", kind, 2, {0.5, 0.5, 0.2}));
            if (!added) throw std::runtime_error(added.errors().front().message);
          } else {
            require(simulation.remove_body(*simulation.find_body("new")));
          }
        });
    add_case(cases, std::string("piles up in one place: ") + to_string(kind), Expected::may_stop,
             [kind](Simulation& simulation, std::uint32_t tick) {
               const auto added = simulation.add_body(
                   make_block("new " + std::to_string(tick), kind, 2, {0.5, 0.5, 0.5}));
               if (!added) throw std::runtime_error(added.errors().front().message);
             });
  }
  add_case(cases, "removes one after the other, to nothing", Expected::runs,
           [](Simulation& simulation, std::uint32_t tick) {
             const auto bodies = simulation.bodies();
             if (tick % 4 == 3 && !bodies.empty()) require(simulation.remove_body(bodies[0].id));
           });
}

void add_laws(Cases& cases) {
  add_case(cases, "gravity turned about at every tick", Expected::runs,
           [](Simulation& simulation, std::uint32_t tick) {
             require(simulation.set_gravity((tick % 2 == 0 ? 20 : -20) * Vec3(1, 0.5, 1)));
           });
  add_case(cases, "the greatest gravity, turned about", Expected::may_stop,
           [](Simulation& simulation, std::uint32_t tick) {
             require(simulation.set_gravity((tick % 2 == 0 ? 1 : -1) *
                                            Vec3(kMaxGravity, -kMaxGravity, kMaxGravity)));
           });
  add_case(
      cases, "contacts made stiff and soft by turns", Expected::may_stop,
      [](Simulation& simulation, std::uint32_t tick) {
        require(simulation.set_interface({{"water", "wood"}, {tick % 2 == 0 ? 1e8 : 1e-3, 0}, {}}));
      });
  add_case(cases, "walls taken away and given back", Expected::may_stop,
           [](Simulation& simulation, std::uint32_t tick) {
             require(simulation.set_interface(
                 {{"water", kVatMaterial}, {tick % 2 == 0 ? 0 : 1e4, 0}, {}}));
           });
}

void add_hands(Cases& cases) {
  for (const Real force : {10.0, kMaxForce}) {
    add_case(cases, "force of " + label(force) + " N on the cube",
             force > 100 ? Expected::may_stop : Expected::runs,
             [force](Simulation& simulation, std::uint32_t tick) {
               require(simulation.apply_force(*simulation.find_body("cube"),
                                              {tick % 2 == 0 ? force : -force, 0, 0}, 0.01));
             });
  }
  for (const char* body : {"pool", "jelly", "cube"}) {
    for (const Real distance : {0.2, 1e6}) {
      add_case(cases, std::string(body) + " grabbed and flung by " + label(distance) + " m",
               distance > 1 ? Expected::may_stop : Expected::runs,
               [body, distance](Simulation& simulation, std::uint32_t tick) {
                 const Vec3 target = Vec3(0.5, 0.5, 0.5) +
                                     (tick % 2 == 0 ? distance : -distance) * Vec3(0.9, 0.3, 0.1);
                 require(tick == 0
                             ? simulation.grab_start(1, *simulation.find_body(body), 0, target)
                             : simulation.grab_move(1, target));
               });
    }
  }
  add_case(
      cases, "grabbed body removed", Expected::runs,
      [](Simulation& simulation, std::uint32_t tick) {
        if (tick == 3) {
          require(simulation.grab_start(1, *simulation.find_body("jelly"), 0, {0.5, 0.5, 0.8}));
        }
        if (tick == 6) require(simulation.remove_body(*simulation.find_body("jelly")));
      });
}

/// Passes a value to every command that takes numbers. Each must refuse it and change nothing.
void inject(Simulation& simulation, Real value) {
  const std::uint64_t before = simulation.state_hash();
  const BodyId cube = *simulation.find_body("cube");
  const Vec3 bad(0, value, 0);
  BodyDescription body = make_block("bad", BodyKind::rigid, 2, bad);
  const bool taken =
      simulation.set_gravity(bad).ok() || simulation.apply_force(cube, bad, 0.01).ok() ||
      simulation.apply_force(cube, {1, 0, 0}, value).ok() ||
      simulation.grab_start(1, cube, 0, bad).ok() || simulation.add_body(body).ok() ||
      simulation.set_interface({{"water", "wood"}, {value, 0}, {}}).ok();
  if (taken || simulation.state_hash() != before) throw std::runtime_error("was taken");
  require(simulation.grab_start(2, cube, 0, {0.6, 0.5, 0.4}));
  if (simulation.grab_move(2, bad).ok())
    throw std::runtime_error("a grab accepted an invalid target");
  require(simulation.grab_end(2));
}

void add_injections(Cases& cases) {
  for (const Real value :
       {std::numeric_limits<Real>::quiet_NaN(), std::numeric_limits<Real>::infinity(), -1e30}) {
    add_case(cases, "commands of " + label(value), Expected::runs,
             [value](Simulation& simulation, std::uint32_t) { inject(simulation, value); });
  }
}

void add_long_calls(Cases& cases) {
  Scene scene = make_crowded_tank();
  scene.numerics.tick = kMaxTick;
  cases.push_back({.group = "a tick of 1 s", .name = "a tick of 1 s", .scene = scene});
  scene.numerics.step = 1e-5;
  scene.numerics.tick = kMaxStepsPerTick * scene.numerics.step;
  scene.bodies.resize(1);
  scene.bodies[0] = make_block("pool", BodyKind::liquid, 3, {0.5, 0.5, 0.14});
  cases.push_back({.group = "a tick of 10 000 steps",
                   .name = "a tick of 10 000 steps",
                   .scene = scene,
                   .duration = 0.1});
}

}  // namespace

void add_command_cases(Cases& cases) {
  add_bodies(cases);
  add_laws(cases);
  add_hands(cases);
  add_injections(cases);
  add_long_calls(cases);
}

std::vector<AdversarialCase> adversarial_cases() {
  Cases cases;
  for (const auto add :
       {add_overlap_cases, add_compression_cases, add_stiffness_cases, add_motion_cases,
        add_place_cases, add_range_cases, add_refusal_cases, add_command_cases}) {
    add(cases);
  }
  return cases;
}

std::vector<AdversarialCase> with_other_integrators(const std::vector<AdversarialCase>& cases) {
  std::vector<AdversarialCase> result;
  for (const AdversarialCase& original : cases) {
    if (original.expected == Expected::refusal) continue;
    for (const IntegratorId integrator : test::kIntegrators) {
      if (integrator == IntegratorId::velocity_verlet) continue;
      AdversarialCase other = original;
      other.name += std::string(", ") + vat::to_string(integrator);
      other.scene.numerics.integrator = integrator;
      // Steps and conditions suit velocity Verlet. With another integrator, the guard may stop the
      // run.
      other.expected = Expected::may_stop;
      other.judge = {};
      result.push_back(other);
    }
  }
  return result;
}

std::vector<AdversarialCase> with_sub_steps(const std::vector<AdversarialCase>& cases) {
  std::vector<AdversarialCase> result;
  for (const AdversarialCase& original : cases) {
    if (original.expected == Expected::refusal) continue;
    std::optional<Scene> scene = with_sub_steps(original.scene);
    if (!scene) continue;
    result.push_back(original);
    result.back().name += ", sub-steps";
    result.back().scene = *std::move(scene);
    result.back().judge = {};  // compares with fixed steps
  }
  return result;
}

}  // namespace vat::stability
