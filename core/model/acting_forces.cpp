#include "core/model/acting_forces.h"

#include <algorithm>

#include "core/model/model.h"

namespace vat {

bool has_viscosity(const Model& model) {
  for (const ModelBody& body : model.bodies) {
    if (body.kind == BodyKind::liquid && model.liquids[body.material]->viscosity > 0) return true;
  }
  return false;
}

bool has_contact_forces(const Model& model) {
  return model.contact_reach > 0 && (model.bodies_push || model.has_self_contact);
}

bool has_wall_forces(const Model& model) {
  const bool is_all_coupled = model.is_coupled && model.liquid_count == model.particle_count;
  return !model.walls.empty() && model.walls_push && !is_all_coupled;
}

bool is_thick(const LiquidModel& liquid, int dimensions) {
  return 2 * (dimensions + 2) * liquid.viscosity > liquid.central_viscosity / 2;
}

bool has_viscous_images(const Model& model) {
  if (!model.is_coupled || model.walls.empty()) return false;
  const bool is_dragged = !model.no_slip_walls.empty();
  return std::ranges::any_of(model.bodies, [&](const ModelBody& body) {
    if (body.kind != BodyKind::liquid) return false;
    const LiquidModel& liquid = *model.liquids[body.material];
    return (is_dragged && liquid.central_viscosity > 0) || is_thick(liquid, model.scene.dimensions);
  });
}

}  // namespace vat
