#pragma once

namespace vat {

struct LiquidModel;
struct Model;

/// Whether some liquid of the model is viscous, and viscosity on.
bool has_viscosity(const Model& model);

/// Whether particles that meet push each other, by springs or layers: there is a stage "contacts".
bool has_contact_forces(const Model& model);

/// The same of walls: there is a stage "walls".
bool has_wall_forces(const Model& model);

/// Whether walls take part in the viscosity of liquids, see core/liquid/pairs/viscous_images.h; and
/// whether slip ones do.
bool has_viscous_images(const Model& model);
bool is_thick(const LiquidModel& liquid, int dimensions);

}  // namespace vat
