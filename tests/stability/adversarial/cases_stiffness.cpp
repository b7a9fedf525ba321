#include <algorithm>
#include <cmath>

#include "tests/stability/adversarial/cases.h"
#include "tests/stability/builders.h"

namespace vat::stability {
namespace {

/// Two stacked balls. Under the weight, the contacts overlap by a tenth of a radius.
Scene make_stack(Real lower_mass, Real upper_mass) {
  Scene scene = make_tank();
  const Real radius = 0.05;
  const Real stiffness = (lower_mass + upper_mass) * 9.81 / (0.1 * radius);
  scene.default_interface = {stiffness,
                             0.1 * std::sqrt(stiffness * std::min(lower_mass, upper_mass))};
  for (auto& interface : scene.interfaces) interface.constants = scene.default_interface;
  scene.bodies = {
      make_particle("lower", BodyKind::rigid, {0.5, 0.5, radius}, lower_mass, radius),
      make_particle("upper", BodyKind::rigid, {0.5, 0.5, 3 * radius}, upper_mass, radius)};
  take_stable_step(scene, 0.4);
  return scene;
}

void add_mass_ratios(Cases& cases) {
  for (const Real ratio : {1.0, 10.0, 100.0, 1e3, 1e4}) {
    const std::string to = " 1 : " + label(ratio);
    cases.push_back({.group = "heavy on light",
                     .name = "heavy on light," + to,
                     .scene = make_stack(0.01, 0.01 * ratio)});
    cases.push_back({.group = "light on heavy",
                     .name = "light on heavy," + to,
                     .scene = make_stack(0.01 * ratio, 0.01)});

    Scene pair = make_scene();
    pair.gravity = Vec3::Zero();
    pair.bodies = {make_spring_pair("pair", 1.5, 1, {100, 0}, {0.01, 0.01 * ratio})};
    take_stable_step(pair, 0.5);
    cases.push_back(
        {.group = "spring between masses", .name = "spring between masses" + to, .scene = pair});

    Scene pool = make_tank();
    for (auto& interface : pool.interfaces) {
      interface.constants.stiffness = std::max(1e4, 1e4 * ratio * 9.81 / 10);
    }
    pool.bodies = {make_block("pool", BodyKind::liquid, 6, {0.5, 0.5, 0.2}),
                   make_particle("ball", BodyKind::rigid, {0.5, 0.5, 0.5}, 0.125 * ratio)};
    take_stable_step(pool, 0.4);
    cases.push_back({.group = "ball on a pool", .name = "ball on a pool," + to, .scene = pool});
  }
}

/// A chain of alternating stiff and soft springs.
BodyDescription make_chain(Real stiff, Real soft) {
  ParticleShape shape = test::make_particles({}, 1);
  for (int n = 0; n < 12; ++n) shape.positions.push_back({0.05 * n, 0, 0});
  shape.masses.assign(12, 0.1);
  shape.fixed = {0};
  BodyDescription chain =
      test::make_body("chain", BodyKind::deformable, "rubber", std::move(shape), 0.025);
  for (Index n = 0; n + 1 < 12; ++n) {
    chain.springs.push_back({n, n + 1, {n % 2 == 0 ? stiff : soft, 0}, {}});
  }
  return chain;
}

void add_stiff_beside_soft(Cases& cases) {
  for (const Real ratio : {1e2, 1e4, 1e6}) {
    const std::string by = " by " + label(ratio);
    Scene chain = make_scene();
    chain.bodies = {make_chain(10 * ratio, 10)};
    take_stable_step(chain, 0.5);
    cases.push_back({.group = "chain of stiff and soft springs",
                     .name = "chain of stiff and soft springs" + by,
                     .scene = chain,
                     .duration = 0.2});

    Scene blocks = make_tank();
    blocks.bodies = {make_block("soft", BodyKind::deformable, 3, {0.5, 0.5, 0.076}),
                     make_block("stiff", BodyKind::deformable, 3, {0.5, 0.5, 0.23})};
    for (SpringDescription& spring : blocks.bodies[1].springs) {
      spring.constants = {2000 * ratio, 2};
    }
    take_stable_step(blocks, 0.5);
    cases.push_back({.group = "stiff block on a soft one",
                     .name = "stiff block on a soft one" + by,
                     .scene = blocks,
                     .duration = 0.2});
  }
}

/// Steps of a multiple of the stable step. The guard may stop the run.
void add_long_steps(Cases& cases) {
  Scene oscillator = make_scene();
  oscillator.bodies = {make_spring_pair("pair", 1.1, 1, {100, 0}, {0.1, 0.1})};
  Scene lattice = make_scene();
  lattice.bodies = {make_block("block", BodyKind::deformable, 4, Vec3::Zero())};
  lattice.bodies[0].angular_velocity = {1, 2, 3};
  Scene contact = make_tank();
  contact.default_interface = {1e5, 0};
  contact.bodies = {make_block("lower", BodyKind::rigid, 3, {0.5, 0.5, 0.08}),
                    make_block("upper", BodyKind::rigid, 3, {0.5, 0.5, 0.23})};
  Scene liquid = make_tank();
  liquid.bodies = {make_block("pool", BodyKind::liquid, 6, {0.5, 0.5, 0.2})};

  const std::pair<const char*, const Scene*> scenes[] = {{"oscillator", &oscillator},
                                                         {"lattice", &lattice},
                                                         {"contact", &contact},
                                                         {"liquid", &liquid}};
  for (const auto& [name, scene] : scenes) {
    for (const Real part : {1.1, 2.0, 5.0, 50.0}) {
      AdversarialCase adversarial{
          .group = std::string("too long steps of a ") + name,
          .name = std::string(name) + " with steps of " + label(part) + " times the limit",
          .scene = *scene,
          .expected = Expected::may_stop,
          .duration = 2};
      const Real step = std::min(part * least_step_limit(*scene), 0.1);
      adversarial.scene.numerics.step = adversarial.scene.numerics.tick = step;
      cases.push_back(adversarial);
    }
  }
}

}  // namespace

void add_stiffness_cases(Cases& cases) {
  add_mass_ratios(cases);
  add_stiff_beside_soft(cases);
  add_long_steps(cases);
}

}  // namespace vat::stability
