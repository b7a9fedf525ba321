#include "protocol/scene/numerics_change.h"

#include "core/limits.h"
#include "protocol/scene/scene_parts.h"

namespace vat {
namespace {

template <class Enum>
void read_name(ObjectReader& reader, std::string_view key, std::optional<Enum>& value) {
  if (reader.has(key)) value = scene_parts::read_enum<Enum>(reader, key);
}

void read_number(ObjectReader& reader, std::string_view key, std::optional<Real>& value) {
  if (reader.has(key)) value = reader.real(key, kAnyMin, kAnyMax);
}

}  // namespace

NumericsChange read_numerics_change(ObjectReader& reader) {
  NumericsChange change;
  read_name(reader, "integrator", change.integrator);
  if (reader.has("step")) change.step = reader.real("step", kMinStep, kMaxStep);
  read_name(reader, "control", change.control);
  read_number(reader, "tolerance", change.tolerance);
  read_number(reader, "density_tolerance", change.density_tolerance);
  read_number(reader, "divergence_tolerance", change.divergence_tolerance);
  return change;
}

Json write_numerics_change(const NumericsChange& change) {
  Json json = Json::object();
  if (change.integrator) json["integrator"] = to_string(*change.integrator);
  if (change.step) json["step"] = *change.step;
  if (change.control) json["control"] = to_string(*change.control);
  if (change.tolerance) json["tolerance"] = *change.tolerance;
  if (change.density_tolerance) json["density_tolerance"] = *change.density_tolerance;
  if (change.divergence_tolerance) json["divergence_tolerance"] = *change.divergence_tolerance;
  return json;
}

}  // namespace vat
