#include <algorithm>
#include <sstream>

#include "core/limits.h"
#include "core/validation/validate_parts.h"

namespace vat {

void check_melting(const Scene& scene, const BodyDescription& body, const std::string& into,
                   const std::string& path, const std::string& into_path, RangeCheck& check) {
  if (body.kind != BodyKind::deformable) {
    check.add("not_allowed", path, "only a deformable body melts");
    return;
  }
  const Real least_support = min_surface_support(scene.surface_model == SurfaceModel::cohesion);
  const auto material = std::ranges::find(scene.materials, into, &Material::name);
  if (material == scene.materials.end()) {
    check.add_unknown(into_path, "must be the name of one of the scene's materials", into,
                      scene.materials, &Material::name);
  } else if (!material->liquid) {
    check.add("not_liquid", into_path,
              "must be a material with liquid constants, since the body becomes liquid");
  } else if (!std::holds_alternative<ParticleShape>(body.shape) &&
             material->liquid->support_radius > kMaxReachInSpacings * body.spacing) {
    check.add("out_of_range", into_path,
              "must have a support radius of at most 8 spacings of the body");
  } else if (!std::holds_alternative<ParticleShape>(body.shape) &&
             material->liquid->surface_tension > 0 &&
             material->liquid->support_radius < least_support * body.spacing * (1 - 1e-9)) {
    std::ostringstream message;
    message << "must have a support radius of at least " << least_support
            << " spacings of the body for its surface tension";
    check.add("out_of_range", into_path, message.str());
  }
}

}  // namespace vat
