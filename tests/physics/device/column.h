#pragma once

#include "tests/physics/device/on_device.h"

namespace vat::test {

inline constexpr Real kColumnSpacing = 0.02;  // [m]

/// A column of water that is narrower than its vat, so that it collapses.
inline Scene make_column() {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 1e-3);
  scene.pressure_solver = PressureSolver::tait;
  scene.gravity = {0, 0, -9.81};
  scene.materials = {make_liquid("water", 1000, {400, 0.01, 2 * kColumnSpacing})};
  scene.materials[0].liquid->artificial_viscosity = 0.1;
  scene.vat = Vat{{0, 0, 0}, {0.3, 0.12, 0.4}, false, {}};
  scene.bodies = {BodyDescription{"column", BodyKind::liquid, "water",
                                  BoxShape{{0.08, 0.06, 0.12}, {0.16, 0.12, 0.24}},
                                  kColumnSpacing}};
  return scene;
}

}  // namespace vat::test
