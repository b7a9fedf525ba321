#include "core/model/surface_tension.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/scene/interface_table.h"

namespace vat {

void compile_surface_tension(Model& model) {
  const Scene& scene = model.scene;
  model.has_surface_tension = std::ranges::any_of(model.bodies, [&](const ModelBody& body) {
    return body.kind == BodyKind::liquid && body.particles.size() > 0 &&
           model.liquids[body.material]->surface_tension > 0;
  });
  if (!model.has_surface_tension) return;
  const InterfaceTable table(scene.materials, scene.interfaces);
  for (std::size_t m = 0; m < scene.materials.size(); ++m) {
    const auto interface = table.with_walls(m);
    const Real angle = interface ? scene.interfaces[*interface].contact_angle : kNeutralAngle;
    model.wall_cosines.push_back(angle == kNeutralAngle ? 0
                                                        : std::cos(angle * std::numbers::pi / 180));
  }
}

}  // namespace vat
