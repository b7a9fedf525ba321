#pragma once

namespace vat {

struct LiquidModel;
struct Model;

/// Returns whether a liquid of the model is viscous.
bool has_viscosity(const Model& model);

/// Returns whether the plan has the stage "contacts": particles repel each other by springs or
/// layers.
bool has_contact_forces(const Model& model);

/// Returns whether the plan has the stage "walls".
bool has_wall_forces(const Model& model);

/// Returns whether walls take part in the viscosity of liquids; see
/// core/liquid/pairs/viscous_images.h.
bool has_viscous_images(const Model& model);
/// Returns whether slip walls take part in the viscosity of this liquid.
bool is_thick(const LiquidModel& liquid, int dimensions);

}  // namespace vat
