#include "core/device/solid/device_restitution.h"

#include <algorithm>

namespace vat {
namespace {

using opencl::Program;

constexpr std::size_t kDirection = 3 * sizeof(double);
/// The struct Mobility of contact_terms.cl.
constexpr std::size_t kMobility = 13 * sizeof(double);

std::size_t bytes_of_changes(const Model& model) {
  return std::max<std::size_t>(1, model.rigid_bodies.size()) * 2 * kDirection;
}

}  // namespace

DeviceRestitution::DeviceRestitution(Program& program, const Model& model)
    : program_(program),
      count_(SolidRange(model).count),
      bodies_(model.rigid_bodies.size()),
      direction_(program, count_ * kDirection),
      changes_of_bodies_(program, bytes_of_changes(model)),
      mobilities_(program, count_ * kMobility) {}

std::size_t DeviceRestitution::bytes_for(const Model& model) {
  return SolidRange(model).count * (kDirection + kMobility) + bytes_of_changes(model);
}

void DeviceRestitution::find(const SolidParameters& p, const PlacedSolids& solids) {
  const SolidTables& t = solids.tables;
  const DeviceRigidBodies& r = solids.rigid;
  program_.run("find_contact_directions", count_, p, solids.cells.begins, solids.order,
               solids.sorted, solids.position, solids.predicted, r.spins, t.mass, t.radius,
               t.body_of, t.bodies, t.laws, t.exclusion_begin, t.exclusions, direction_);
  if (bodies_ > 0) {
    program_.run_in_lanes("push_bodies_by_contacts", bodies_ * Program::kGroup, r.rigid, r.poses,
                          solids.position, direction_, changes_of_bodies_);
  }
  program_.run("find_contact_mobilities", count_, p, t.mobility, r.rigid_of, r.rigid, r.poses,
               solids.position, direction_, changes_of_bodies_, mobilities_);
}

}  // namespace vat
