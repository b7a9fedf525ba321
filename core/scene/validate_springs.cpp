#include <algorithm>

#include "core/scene/validate_parts.h"

namespace vat {

void check_implicit_springs(const Scene& scene, RangeCheck& check) {
  const bool any = scene.forces.springs &&
                   std::ranges::any_of(scene.materials, &Material::implicit_springs);
  if (!any || scene.numerics.accuracy) return;
  if (scene.numerics.integrator != IntegratorId::velocity_verlet) {
    check.add("not_allowed", "/numerics/integrator",
              "must be \"velocity_verlet\", since a material has implicit springs");
  }
  if (scene.numerics.control == StepControl::local) {
    check.add("not_allowed", "/numerics/control",
              "must be \"fixed\" or \"adaptive\", since a material has implicit springs");
  }
}

}  // namespace vat
