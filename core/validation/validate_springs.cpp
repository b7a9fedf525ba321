#include <algorithm>

#include "core/limits.h"
#include "core/validation/validate_parts.h"

namespace vat {

void check_spring_changes(const Material& material, const std::string& path, RangeCheck& check) {
  if (material.tearing_strain) {
    check.real(*material.tearing_strain, kMinStrain, kMaxStrain, path + "/tearing_strain");
  }
  check.real(material.bulk_modulus, 0, kMaxStiffness, path + "/bulk_modulus");
  if (material.bulk_modulus > 0 && material.tearing_strain) {
    check.add("not_allowed", path + "/bulk_modulus",
              "must be left out, since the material tears: a gap has no volume to keep");
  }
  if (material.elongation_limit) {
    check.real(*material.elongation_limit, 0, kMaxStrain, path + "/elongation_limit");
    if (material.implicit_springs) {
      check.add("not_allowed", path + "/elongation_limit",
                "must be left out, since the material's springs are implicit");
    }
  }
  if (!material.plasticity) return;
  const Plasticity& plasticity = *material.plasticity;
  const std::string at = path + "/plasticity";
  check.real(plasticity.yield_strain, 0, kMaxStrain, at + "/yield_strain");
  check.real(plasticity.hardening, 0, kMaxHardening, at + "/hardening");
  check.real(plasticity.relaxation_time, 0, kMaxPeriod, at + "/relaxation_time");
  check.real(plasticity.max_strain, 0, kMaxPlasticStrain, at + "/max_strain");
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
