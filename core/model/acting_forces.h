#pragma once

namespace vat {

struct LiquidModel;
struct Model;

/// Returns whether any liquid of the model is viscous.
bool has_viscosity(const Model& model);

/// Returns whether the plan contains the stage "contacts", in which penalties or Lennard-Jones
/// layers exert contact forces between particles.
bool has_contact_forces(const Model& model);

/// Returns whether the plan contains the stage "walls".
bool has_wall_forces(const Model& model);

/// Returns whether walls contribute to the viscosity of liquids; see
/// core/liquid/pairs/viscous_images.h.
bool has_viscous_images(const Model& model);
/// Returns whether slip walls contribute to the viscosity of this liquid.
bool is_thick(const LiquidModel& liquid, int dimensions);

}  // namespace vat
