#include "core/rigid/mass_properties.h"

namespace vat {

MassProperties mass_properties(const SampledBody& body) {
  MassProperties result;
  Vec3 moment = Vec3::Zero();
  for (std::size_t i = 0; i < body.positions.size(); ++i) {
    result.mass += body.masses[i];
    moment += body.masses[i] * body.positions[i];
  }
  result.center_of_mass = moment / result.mass;
  result.inertia = Mat3::Zero();
  for (std::size_t i = 0; i < body.positions.size(); ++i) {
    const Vec3 x = body.positions[i] - result.center_of_mass;
    const Real own = 0.4 * body.radii[i] * body.radii[i];
    result.inertia +=
        body.masses[i] * ((x.squaredNorm() + own) * Mat3::Identity() - x * x.transpose());
  }
  return result;
}

}  // namespace vat
