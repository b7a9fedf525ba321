#include "core/sampling/mass_properties.h"

#include "core/support/check.h"

namespace vat {
namespace {

/// Mass and centre of mass, without inertia.
MassProperties without_inertia(const SampledBody& body) {
  MassProperties result;
  Vec3 moment = Vec3::Zero();
  for (std::size_t i = 0; i < body.positions.size(); ++i) {
    result.mass += body.masses[i];
    moment += body.masses[i] * body.positions[i];
  }
  VAT_CHECK(result.mass > 0);
  result.center_of_mass = moment / result.mass;
  result.inertia = Mat3::Zero();
  return result;
}

}  // namespace

MassProperties mass_properties(const SampledBody& body) {
  MassProperties result = without_inertia(body);
  for (std::size_t i = 0; i < body.positions.size(); ++i) {
    const Vec3 x = body.positions[i] - result.center_of_mass;
    const Real own = 0.4 * body.radii[i] * body.radii[i];
    result.inertia +=
        body.masses[i] * ((x.squaredNorm() + own) * Mat3::Identity() - x * x.transpose());
  }
  return result;
}

MassProperties plane_mass_properties(const SampledBody& body) {
  MassProperties result = without_inertia(body);
  Real inertia = 0;
  for (std::size_t i = 0; i < body.positions.size(); ++i) {
    const Vec3 x = body.positions[i] - result.center_of_mass;
    inertia += body.masses[i] * (x.squaredNorm() + 0.5 * body.radii[i] * body.radii[i]);
  }
  result.inertia = inertia * Mat3::Identity();
  return result;
}

}  // namespace vat
