#include <algorithm>

#include "core/validation/validate_parts.h"

namespace vat {

void check_spring_changes(const Material& material, const std::string& path, RangeCheck& check) {
  if (material.bulk_modulus > 0 && material.tearing_strain) {
    check.add("not_allowed", path + "/bulk_modulus",
              "must be left out for a material with a tearing strain");
  }
  if (material.elongation_limit && material.implicit_springs) {
    check.add("not_allowed", path + "/elongation_limit",
              "must be left out, since the material's springs are implicit");
  }
}

namespace {

void check_integrator(const Numerics& numerics, bool implicit, const std::string& since,
                      RangeCheck& check) {
  const IntegratorId integrator = numerics.integrator;
  if (integrator == IntegratorId::velocity_verlet) return;
  if (integrator == IntegratorId::symplectic_euler && !implicit) return;
  const char* allowed = implicit ? "must be \"velocity_verlet\", since a material has "
                                 : "must be \"velocity_verlet\" or \"symplectic_euler\", since "
                                   "a material has ";
  check.add("not_allowed", "/numerics/integrator", allowed + since);
}

}  // namespace

void check_spring_numerics(const Scene& scene, RangeCheck& check) {
  if (!scene.forces.springs || scene.numerics.accuracy) return;
  const auto any = [&](auto&& has) { return std::ranges::any_of(scene.materials, has); };
  const bool implicit = any(&Material::implicit_springs);
  const bool limited = any([](const Material& m) { return m.elongation_limit.has_value(); });
  const bool has_volume = any([](const Material& m) { return m.bulk_modulus > 0; });
  const char* since = implicit  ? "implicit springs"
                      : limited ? "an elongation limit"
                                : "a bulk modulus";
  if (implicit || limited) check_integrator(scene.numerics, implicit, since, check);
  if (scene.numerics.control == StepControl::local && (implicit || limited || has_volume)) {
    check.add("not_allowed", "/numerics/control",
              std::string("must be \"fixed\" or \"adaptive\", since a material has ") + since);
  }
}

}  // namespace vat
