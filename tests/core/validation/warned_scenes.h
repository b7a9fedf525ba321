#pragma once

#include <gtest/gtest.h>

#include <string>

#include "core/validation/validate.h"
#include "tests/support/scenes.h"

namespace vat::test {

/// Returns "code path" of each warning, one per line, without the warnings of run time ("slow").
inline std::string warnings_of(const Scene& scene) {
  EXPECT_TRUE(find_errors(scene).empty());
  std::string found;
  for (const Warning& warning : find_warnings(scene)) {
    if (warning.code == "slow") continue;
    found += (found.empty() ? "" : "\n") + warning.code + ' ' + warning.path;
  }
  return found;
}

inline Scene two_balls(Real distance) {
  Scene scene;
  scene.pressure_solver = PressureSolver::gas;
  scene.materials.emplace_back();
  scene.materials[0].name = "wood";
  const SphereShape ball{{0, 0, 0}, 0.1};
  scene.bodies = {{"a", BodyKind::rigid, "wood", ball, 0.05},
                  {"b", BodyKind::rigid, "wood", ball, 0.05}};
  scene.bodies[1].position = {distance, 0, 0};
  return scene;
}

/// A mass on a spring that is attached to a fixed point: omega^2 = stiffness / 1 kg.
inline Scene oscillator(Real stiffness, Real damping) {
  Scene scene;
  scene.pressure_solver = PressureSolver::gas;
  scene.materials.emplace_back();
  scene.materials[0].name = "m";
  scene.bodies.resize(1);
  scene.bodies[0].name = "pair";
  scene.bodies[0].kind = BodyKind::deformable;
  scene.bodies[0].material = "m";
  scene.bodies[0].shape = ParticleShape{{{0, 0, 0}, {1, 0, 0}}, {}, {1, 1}, {0.1, 0.1}, {0}};
  scene.bodies[0].springs = {{0, 1, {stiffness, damping}, {}}};
  return scene;
}

/// A cube of liquid with the `gas` solver.
inline Scene pool(const LiquidConstants& liquid, Real size = 1) {
  Scene scene;
  scene.pressure_solver = PressureSolver::gas;
  scene.materials = {test::make_liquid("water", 1000, liquid)};
  scene.bodies = {
      {"pool", BodyKind::liquid, "water", BoxShape{Vec3::Zero(), Vec3::Constant(size)}, 0.05}};
  return scene;
}

}  // namespace vat::test
