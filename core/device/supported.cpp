#include "core/device/supported.h"

#include <algorithm>

#include "core/damping/damping_solve.h"
#include "core/device/incompressible/device_step_control.h"

namespace vat {
namespace {

/// Returns whether a step can be too long for explicit viscosity.
bool may_solve_viscosity(const Model& model) {
  const Numerics& numerics = model.scene.numerics;
  if (!model.is_incompressible) return must_solve_viscosity(model, numerics.step);
  const bool is_adaptive = numerics.control == StepControl::adaptive;
  return must_solve_own_damping(model, is_adaptive ? longest_adaptive_step(model) : numerics.step);
}

}  // namespace

Errors find_features_not_on_device(const Model& model) {
  Errors errors;
  const Scene& scene = model.scene;
  const auto reject = [&](bool is_used, const std::string& path, const std::string& message) {
    if (is_used) errors.push_back({"not_on_device", path, message});
  };
  const bool is_incompressible = scene.pressure_solver == PressureSolver::incompressible;
  reject(scene.pressure_solver == PressureSolver::gas, "/pressure_solver",
         "must be tait or incompressible on a device");
  reject(model.liquid_count == 0, "/bodies", "must contain a liquid on a device");
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const BodyDescription& body = scene.bodies[b];
    const std::string path = "/bodies/" + std::to_string(b);
    const bool is_supported =
        body.kind == BodyKind::liquid || (body.kind == BodyKind::rigid && body.fixed);
    reject(!is_supported, path + "/kind", "must be liquid, or rigid and fixed, on a device");
    if (body.kind == BodyKind::liquid) {
      reject(model.bodies[b].material != model.material.at(0), path + "/material",
             "must be the material of the other liquids on a device");
    }
    if (body.kind != BodyKind::rigid) continue;
    reject(body.motion.has_value(), path + "/motion", "must be absent on a device");
    reject(!body.velocity.isZero(0), path + "/velocity", "must be 0 on a device");
    reject(!body.angular_velocity.isZero(0), path + "/angular_velocity", "must be 0 on a device");
  }
  if (!errors.empty()) return errors;
  reject(!scene.emitters.empty(), "/emitters", "must be empty on a device");
  reject(!scene.drains.empty(), "/drains", "must be empty on a device");
  reject(model.periodic.any(), "/periodic", "must be absent on a device");
  reject(scene.central_field.has_value(), "/central_field", "must be absent on a device");
  reject(scene.sleeping.has_value(), "/sleeping", "must be absent on a device");
  reject(scene.kernel != KernelId::wendland_c2, "/kernel", "must be wendland_c2 on a device");
  reject(scene.pair_precision != PairPrecision::single_precision, "/pair_precision",
         "must be single on a device");
  // An incompressible liquid requires symplectic Euler.
  reject(!is_incompressible && scene.numerics.integrator != IntegratorId::velocity_verlet,
         "/numerics/integrator", "must be velocity_verlet on a device");
  reject(is_incompressible && !scene.forces.pressure, "/forces/pressure",
         "must be true for an incompressible liquid on a device");
  const StepControl control = scene.numerics.control;
  reject(!is_incompressible && control != StepControl::fixed, "/numerics/control",
         "must be fixed on a device");
  reject(is_incompressible && control == StepControl::local, "/numerics/control",
         "must be fixed or adaptive on a device");
  reject(may_solve_viscosity(model), "/numerics/step",
         "must resolve the viscosity of the liquid on a device");
  reject(model.has_surface_tension || model.cohesion.has_value(), "/materials",
         "must have no surface tension on a device");
  reject(model.is_filled, "/vat/lid", "must be false for a vat full of liquid on a device");
  return errors;
}

}  // namespace vat
