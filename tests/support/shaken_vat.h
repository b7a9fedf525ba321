#pragma once

#include "tests/support/mixed_scenes.h"

namespace vat::test {

/// Every kind of body in contact in a sliding vat, with gravity and viscosity, so that a step
/// computes all its parts.
inline Scene make_shaken_vat(IntegratorId integrator, Real step = 1e-3) {
  Scene scene = make_two_material_scene(integrator, step, 2);
  scene.gravity = {0, 0, -9.81};
  scene.vat = Vat{{-0.2, -0.2, -0.12}, {0.2, 0.2, 1}, true, SlideMotion{{1, 0, 0}, 0.1, 1}};
  scene.bodies = {make_block("pool", BodyKind::liquid, "a", 4, Vec3::Zero(), Vec3::Zero()),
                  make_block("jelly", BodyKind::deformable, "b", 3, {0.03, 0, 0.17}, Vec3::Zero()),
                  make_block("crate", BodyKind::rigid, "b", 3, {-0.02, 0.01, 0.31}, Vec3::Zero())};
  return scene;
}

}  // namespace vat::test
