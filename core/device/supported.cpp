#include "core/device/supported.h"

#include <algorithm>
#include <string>
#include <utility>

#include "core/damping/damping_solve.h"
#include "core/device/contact/solid_geometry.h"
#include "core/device/liquid/device_step_control.h"
#include "core/model/acting_forces.h"
#include "core/numerics/step_limits.h"

namespace vat {
namespace {

/// Returns whether a step can be too long for explicit viscosity.
bool may_solve_viscosity(const Model& model) {
  const Numerics& numerics = model.scene.numerics;
  const bool is_adaptive = numerics.control == StepControl::adaptive;
  const Real step = is_adaptive ? longest_adaptive_step(model) : numerics.step;
  return model.is_incompressible ? must_solve_own_damping(model, step)
                                 : must_solve_viscosity(model, step);
}

bool has_motion(const BodyDescription& body) {
  return body.motion.has_value();
}

/// Collects the errors of a scene.
class Missing {
 public:
  explicit Missing(const Model& model) : model_(model) {}

  void check_bodies();
  void check_world();
  void check_liquid();
  void check_gas();
  void check_solids();
  Errors take() && { return std::move(errors_); }
  bool any() const { return !errors_.empty(); }

 private:
  void reject(bool is_used, const std::string& path, const std::string& message) {
    if (is_used) errors_.push_back({"not_on_device", path, message + " on a device"});
  }
  void check_body(std::size_t index);
  void check_laws();
  void check_motions();
  /// Returns whether the scene has sums over pairs that have neither double precision nor several
  /// liquids on devices.
  bool has_further_sums() const {
    return is_incompressible() || model_.has_surface_tension || model_.cohesion ||
           model_.is_filled || may_solve_viscosity(model_) ||
           scene_.numerics.control == StepControl::adaptive;
  }
  bool needs_one_liquid() const { return has_further_sums() || has_viscous_images(model_); }
  bool is_incompressible() const {
    return model_.liquid_count > 0 && scene_.pressure_solver == PressureSolver::incompressible;
  }

  const Model& model_;
  const Scene& scene_ = model_.scene;
  Errors errors_;
};

void Missing::check_body(std::size_t index) {
  const BodyDescription& body = scene_.bodies[index];
  const std::string path = "/bodies/" + std::to_string(index);
  const bool has_liquid = model_.liquid_count > 0;
  reject(!has_liquid && body.kind == BodyKind::liquid, path + "/kind",
         "must be deformable or rigid in a scene whose liquids have no particles");
  if (body.kind == BodyKind::liquid && model_.is_coupled && needs_one_liquid()) {
    reject(
        model_.bodies[index].material != model_.material[0], path + "/material",
        "must be the material of the other liquids, with adaptive steps, incompressible liquids, "
        "surface tension, viscous walls, liquids that fill their world, and steps that do not "
        "resolve the viscosity");
  }
  if (body.kind != BodyKind::rigid) return;
  reject(
      body.axle && (is_incompressible() || model_.has_projection ||
                    scene_.numerics.integrator != IntegratorId::velocity_verlet),
      path + "/axle",
      "must be absent with incompressible liquids, contacts by projection, and integrators other "
      "than velocity_verlet");
}

void Missing::check_bodies() {
  reject(model_.particle_count == 0, "/bodies", "must contain a body");
  for (std::size_t b = 0; b < scene_.bodies.size(); ++b) check_body(b);
}

void Missing::check_world() {
  const bool is_tait = model_.is_coupled && !model_.is_incompressible;
  reject(!scene_.emitters.empty() && !is_tait, "/emitters",
         "must be empty with a pressure solver other than tait");
  reject(scene_.sleeping && model_.liquid_count > 0, "/sleeping",
         "must be absent in a scene with liquids");
}

void Missing::check_gas() {
  reject(may_solve_viscosity(model_), "/numerics/step", "must resolve the viscosity of the liquid");
  check_solids();
}

void Missing::check_liquid() {
  reject(
      scene_.pair_precision != PairPrecision::single_precision && has_further_sums(),
      "/pair_precision",
      "must be single with adaptive steps, incompressible liquids, surface tension, liquids that "
      "fill their world, and steps that do not resolve the viscosity");
  reject(is_incompressible() && !scene_.forces.pressure, "/forces/pressure",
         "must be true for an incompressible liquid");
  const StepControl control = scene_.numerics.control;
  const bool is_verlet = scene_.numerics.integrator == IntegratorId::velocity_verlet;
  // An incompressible liquid requires symplectic Euler.
  reject(!is_incompressible() && !is_verlet && control == StepControl::adaptive,
         "/numerics/control", "must be fixed with an integrator other than velocity_verlet");
  reject(control == StepControl::local, "/numerics/control", "must be fixed or adaptive");
  const bool is_adaptive = control == StepControl::adaptive;
  reject(is_adaptive && solids_move(model_) && !is_incompressible(), "/numerics/control",
         "must be fixed in a scene with bodies that can move");
  reject(is_adaptive && model_.free_count > model_.liquid_count, "/numerics/control",
         "must be fixed in a scene with deformable bodies");
  reject(solids_move(model_) && may_solve_viscosity(model_), "/numerics/step",
         "must resolve the viscosity of the liquid and the damping of bodies");
  reject(is_incompressible() && model_.has_surface_tension, "/materials",
         "must have no surface tension with the pressure solver incompressible");
  reject(scene_.central_field && (is_incompressible() || !model_.walls.empty() ||
                                  model_.particle_count > model_.liquid_count),
         "/central_field",
         "must be absent in a scene with walls, solids or an incompressible liquid");
  reject(model_.is_filled && control == StepControl::adaptive, "/numerics/control",
         "must be fixed for a liquid that fills its world");
  reject(model_.is_filled && !scene_.emitters.empty(), "/emitters",
         "must be empty with a liquid that fills its world");
  reject(may_solve_viscosity(model_) && !scene_.emitters.empty(), "/numerics/step",
         "must resolve the viscosity of the liquid in a scene with emitters");
  if (!solids_move(model_)) return;
  check_motions();
  check_laws();
}

void Missing::check_laws() {
  if (!model_.has_projection) return;
  reject(std::ranges::any_of(scene_.bodies, has_motion),
         scene_.interfaces.empty() ? "/default_interface" : "/interfaces",
         "must have the law penalty or lennard_jones in a scene with driven bodies");
}

void Missing::check_motions() {
  // An incompressible liquid requires symplectic Euler, and has its own steps.
  reject(scene_.numerics.integrator != IntegratorId::velocity_verlet && !is_incompressible() &&
             std::ranges::any_of(scene_.bodies, has_motion),
         "/numerics/integrator", "must be velocity_verlet for driven bodies");
}

void Missing::check_solids() {
  check_motions();
  reject(scene_.numerics.integrator == IntegratorId::symplectic_euler && solves_damping(scene_) &&
             must_solve_own_damping(model_, scene_.numerics.step),
         "/numerics/step", "must resolve the damping of the bodies");
  reject(scene_.numerics.control != StepControl::fixed, "/numerics/control", "must be fixed");
  check_laws();
}

}  // namespace

Errors find_features_not_on_device(const Model& model) {
  Missing missing(model);
  missing.check_bodies();
  if (missing.any()) return std::move(missing).take();
  missing.check_world();
  if (model.liquid_count == 0) {
    missing.check_solids();
  } else if (model.is_coupled) {
    missing.check_liquid();
  } else {
    missing.check_gas();
  }
  return std::move(missing).take();
}

}  // namespace vat
