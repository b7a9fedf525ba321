#include "core/device/solid/device_step_limits.h"

#include <algorithm>
#include <span>
#include <vector>

#include "core/device/common/kernel_values.h"
#include "core/laws/vat_motion.h"
#include "core/state/rigid_motion.h"
#include "core/stepping/control/step_control.h"
#include "core/stepping/control/step_control_liquid.h"

namespace vat {
namespace {

using opencl::Program;

constexpr std::size_t kPrediction = 16 * sizeof(double);

std::size_t rigid_particles(const Model& model) {
  return model.particle_count - model.free_count;
}

}  // namespace

DeviceStepLimits::DeviceStepLimits(Program& program, const Model& model, const DeviceSolids& solids)
    : program_(program),
      solids_(solids),
      scene_step_(find_step_bounds(model).scene_step),
      liquid_travel_(guard_bounds(model).travel[model.body[0]]),
      free_(SolidRange(model).free),
      count_(SolidRange(model).count),
      bodies_(model.rigid_bodies.size()),
      mobility_(program, count_ * sizeof(double)),
      approach_(program, sizeof(double)),
      predictions_(program, rigid_particles(model) * kPrediction),
      partial_(program, bytes_of_partial(count_)),
      steps_(program, bodies_ * sizeof(Double4)),
      least_(program, sizeof(double)) {}

std::size_t DeviceStepLimits::bytes_for(const Model& model) {
  const std::size_t count = SolidRange(model).count;
  return (count + 2) * sizeof(double) + rigid_particles(model) * kPrediction +
         bytes_of_partial(count) + model.rigid_bodies.size() * sizeof(Double4);
}

void DeviceStepLimits::find_mobilities(const Model& model, std::uint64_t step) {
  const std::size_t first = SolidRange(model).first;
  std::vector<double> mobilities;
  for (std::size_t i = first; i < first + count_; ++i) {
    const Real distance = model.has_friction ? model.radius[i] : 0;
    mobilities.push_back(greatest_inverse_mass(model, static_cast<Index>(i), step, distance));
  }
  program_.write(mobility_, std::span<const double>(mobilities));
}

DeviceStepLimits::Search DeviceStepLimits::search_for(const Model& model, Real time, Real longest,
                                                      Real liquid_speed) const {
  const Scene& scene = model.scene;
  const Numerics& numerics = scene.numerics;
  Search search{};
  search.longest = longest;
  search.gained_in_approach = scene.gravity.norm() * longest;
  search.gained_speed = scene.forces.gravity ? search.gained_in_approach : 0;
  search.approach_of_liquid =
      std::min((liquid_speed + search.gained_in_approach) * longest, kTravelShare * liquid_travel_);
  search.reach = model.contact_reach;
  search.vat_speed = scene.vat ? greatest_vat_speed(*scene.vat, time) : 0;
  search.scene_step = scene_step_;
  search.travel_share = kTravelShare;
  // The stable step for this oscillation is 1 s with both integrators.
  search.margin = safe_step(numerics, {4, 0});
  search.phase = contact_phase(numerics);
  search.full_amplitude = kFullAmplitude;
  search.greatest_turn = kGreatestTurn;
  search.damping_limits = numerics.integrator == IntegratorId::symplectic_euler ? 1 : 0;
  return search;
}

Real DeviceStepLimits::least_step(const Model& model, Real time, Real longest, Real liquid_speed) {
  const Search search = search_for(model, time, longest, liquid_speed);
  const SolidParameters p = solids_.parameters(time);
  const PlacedSolids s = solids_.placed();
  const SolidTables& t = s.tables;
  program_.run("find_ways", count_, p, search, s.predicted, t.body_of, t.bodies, partial_);
  program_.run("find_approach", Program::kGroup, search, groups_of(count_), partial_, approach_);
  program_.run("predict_contacts", count_, p, search, approach_, s.cells.begins, s.order, s.sorted,
               s.predicted, t.mass, mobility_, t.radius, t.body_of, t.bodies, t.laws,
               t.exclusion_begin, t.exclusions, predictions_);
  program_.run_in_lanes("limit_steps_of_bodies", bodies_ * Program::kGroup, search,
                        number_of(free_), s.rigid.rigid, s.rigid.poses, s.position, predictions_,
                        steps_);
  program_.run("find_least_step", Program::kGroup, number_of(bodies_), steps_, least_);
  double least = 0;
  program_.read(least_, std::span(&least, 1));
  return least;
}

}  // namespace vat
