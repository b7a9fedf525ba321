#include "core/device/incompressible/device_pushes.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "core/device/common/kernel_values.h"
#include "core/state/rigid_motion.h"

namespace vat {
namespace {

using opencl::Buffer;
using opencl::Program;

constexpr std::size_t kPush = 3 * sizeof(double);

/// Force and torque of each rigid body.
std::size_t bytes_of_resultants(const Model& model) {
  return 2 * std::max<std::size_t>(1, model.rigid_bodies.size()) * kPush;
}

}  // namespace

DevicePushes::DevicePushes(Program& program, const Model& model, const DeviceSolids& solids)
    : program_(program),
      solids_(solids),
      free_(SolidRange(model).free),
      count_(SolidRange(model).count),
      bodies_(model.rigid_bodies.size()),
      roots_(program, count_ * sizeof(float)),
      push_(program, count_ * kPush + bytes_of_resultants(model)),
      total_(program, free_ * kPush + bytes_of_resultants(model)),
      acceleration_(program, bytes_of_resultants(model)) {}

std::size_t DevicePushes::bytes_for(const Model& model) {
  const SolidRange range(model);
  return range.count * (sizeof(float) + kPush) + range.free * kPush +
         3 * bytes_of_resultants(model);
}

void DevicePushes::find_mobilities(const Model& model, std::uint64_t step) {
  std::vector<float> roots(count_);
  for (std::size_t b = 0; b < count_; ++b) {
    const auto particle = static_cast<Index>(model.liquid_count + b);
    roots[b] = static_cast<float>(std::sqrt(greatest_inverse_mass(model, particle, step)));
  }
  program_.write(roots_, std::span<const float>(roots));
}

void DevicePushes::see_solids(const LiquidParameters& p, const SolveParameters& solve,
                              const DeviceParticles& s, const Buffer& solve_motion,
                              const Buffer& squares) {
  const PlacedSolids solids = solids_.placed();
  program_.run("see_solids", s.count(), solve, s.order, s.sorted_place, solids.velocity,
               solids.predicted, roots_, solve_motion);
  program_.run_in_lanes("add_mobility_of_solids", s.count(), p, solve, s.cells.begins,
                        s.sorted_place, s.neighbour_counts, s.plain_counts, s.neighbours,
                        solve_motion, squares);
}

void DevicePushes::begin() {
  program_.fill_with_zeros(total_, (free_ + 2 * bodies_) * kPush);
}

void DevicePushes::accelerate_bodies(const SolveParameters& solve, const DeviceParticles& s,
                                     std::int32_t groups, const Buffer& progress,
                                     const Buffer& solve_motion, const Buffer& partial) {
  if (bodies_ == 0) return;
  const PlacedSolids solids = solids_.placed();
  const DeviceRigidBodies& r = solids.rigid;
  program_.run_in_lanes("accelerate_of_bodies", bodies_ * Program::kGroup, solve, number_of(count_),
                        groups, progress, r.rigid, r.poses, solids.position, push_, acceleration_,
                        partial);
  program_.run("accelerate_rigid_particles", s.count(), solve, progress, s.order, s.sorted_place,
               r.rigid_of, r.poses, solids.position, acceleration_, solve_motion);
}

void DevicePushes::add(const SolveParameters& solve, const Buffer& progress) {
  program_.run("add_pushes", free_ + 2 * bodies_, solve, number_of(count_), number_of(bodies_),
               progress, push_, total_);
}

void DevicePushes::kick(const SolveParameters& solve, const Buffer& progress) {
  const PlacedSolids solids = solids_.placed();
  program_.run("kick_by_pushes", free_ + bodies_, solve, number_of(bodies_), progress,
               solids.tables.mobility, total_, solids.velocity, solids.rigid.poses);
}

}  // namespace vat
