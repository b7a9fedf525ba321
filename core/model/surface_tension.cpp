#include "core/model/compile_parts.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/laws/surface_tension.h"
#include "core/scene/interface_table.h"
#include "core/support/check.h"

namespace vat {
namespace {

Real cosine_of(const Scene& scene, std::optional<std::size_t> interface) {
  const Real angle = interface ? scene.interfaces[*interface].contact_angle : kNeutralAngle;
  return angle == kNeutralAngle ? 0 : std::cos(angle * std::numbers::pi / 180);
}

/// Fills the attraction of each material, and its shares by all materials and by the walls.
void compile_cohesion(Model& model, const InterfaceTable& table) {
  const Scene& scene = model.scene;
  const std::size_t count = scene.materials.size();
  for (std::size_t m = 0; m < count; ++m) {
    const std::optional<LiquidModel>& liquid = model.liquids[m];
    const Real attraction =
        liquid ? attraction_of(liquid->surface_tension, liquid->support_radius, scene.dimensions)
               : 0;
    model.cohesions.push_back(attraction);
    const auto add_share = [&](std::optional<std::size_t> interface) {
      model.adhesion_shares.push_back(adhesion_share(cosine_of(scene, interface)));
    };
    for (std::size_t other = 0; other < count; ++other) add_share(table.between(m, other));
    add_share(table.with_walls(m));
  }
}

}  // namespace

void compile_surface_tension(Model& model) {
  const Scene& scene = model.scene;
  VAT_CHECK(model.liquids.size() == scene.materials.size());
  const auto body = std::ranges::find_if(model.bodies, [&](const ModelBody& each) {
    return each.kind == BodyKind::liquid && each.particles.size() > 0 &&
           model.liquids[each.material]->surface_tension > 0;
  });
  if (body == model.bodies.end()) return;
  const InterfaceTable table(scene.materials, scene.interfaces);
  if (scene.surface_model == SurfaceModel::cohesion) {
    const LiquidModel& liquid = *model.liquids[body->material];
    model.cohesion = CohesionKernel(liquid.support_radius, liquid.spacing, scene.dimensions);
    compile_cohesion(model, table);
    return;
  }
  model.has_surface_tension = true;
  for (std::size_t m = 0; m < scene.materials.size(); ++m) {
    model.wall_cosines.push_back(cosine_of(scene, table.with_walls(m)));
  }
}

}  // namespace vat
