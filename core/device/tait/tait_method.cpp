#include "core/device/tait/tait_method.h"

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/damping/damping_solve.h"
#include "core/device/common/device_motion.h"
#include "core/device/common/verlet_method.h"
#include "core/device/liquid/device_particles.h"
#include "core/device/solid/device_solids.h"

namespace vat {
namespace {

using opencl::Buffer;
using opencl::Program;

/// The integrated variables, in the order of particles.
struct TaitState {
  TaitState(Program& program, std::size_t n)
      : motion(program, n), acceleration(program, n * sizeof(Float4)) {}
  static constexpr std::size_t kBytes = DeviceMotion::kBytes + sizeof(Float4);

  DeviceMotion motion;
  Buffer acceleration;
};

std::unique_ptr<DeviceSolids> make_solids(Program& program, const Model& model) {
  if (!solids_move(model)) return nullptr;
  return std::make_unique<DeviceSolids>(program, model, guard_bounds(model));
}

std::optional<MovingSolids> moving_particles(const DeviceSolids* solids) {
  if (solids == nullptr) return {};
  return MovingSolids{solids->position(), solids->velocity_in_forces()};
}

class TaitMethod : public VerletMethod {
 public:
  TaitMethod(Program& program, std::shared_ptr<const Model> compiled,
             const LiquidGeometry& geometry)
      : VerletMethod(std::move(compiled)),
        program_(program),
        geometry_(geometry),
        solids_(make_solids(program, model())),
        particles_(program, model(), geometry, moving_particles(solids_.get())),
        now_(program, model().liquid_count),
        start_(program, model().liquid_count) {}

  void read(State& state) override;

 private:
  DeviceCounters& counters() override { return particles_.counters; }
  void write(const State& state) override;
  void save() override;
  void restore() override;
  void evaluate(const StepMoment& start, Real end) override;
  bool must_solve(Real dt) const override { return solids_ && solids_->must_solve(dt); }
  std::uint32_t solve_damping(Real end, Real dt) override {
    return solids_->solve_damping(end, dt);
  }
  void finish(const StepMoment& moment) override;
  void copy(const TaitState& from, TaitState& to);
  /// Moves the liquid, and computes its accelerations.
  void evaluate_liquid(const LiquidParameters& p);
  /// Adds the forces between the liquid and moving solids to those of the solids.
  void find_forces_on_solids(const LiquidParameters& p, Real end);

  Program& program_;
  const LiquidGeometry geometry_;
  const std::unique_ptr<DeviceSolids> solids_;  ///< null if all solids are at rest
  DeviceParticles particles_;
  TaitState now_;
  TaitState start_;  ///< state before a call, for a failed step
  ReadMotion read_;
  std::vector<Float4> accelerations_;
};

void TaitMethod::write(const State& state) {
  const std::size_t n = model().liquid_count;
  now_.motion.write(state.now);
  particles_.write_solids(state.now);
  if (solids_) solids_->write(state);
  accelerations_.assign(n, {});
  if (state.forces_current) {
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3 a = state.forces.particle[i] * model().inverse_mass[i];
      accelerations_[i] = {static_cast<float>(a.x()), static_cast<float>(a.y()),
                           static_cast<float>(a.z()), 0};
    }
  }
  program_.write(now_.acceleration, std::span<const Float4>(accelerations_));
}

void TaitMethod::read(State& state) {
  const std::size_t n = model().liquid_count;
  accelerations_.resize(n);
  read_.read(program_, now_.motion, n);
  program_.read(now_.acceleration, std::span<Float4>(accelerations_));
  if (solids_) solids_->read();
  read_.copy_to(state.now);
  // No force acts on solids that are held.
  state.forces.particle.assign(model().particle_count, Vec3::Zero());
  state.forces.rigid_force.assign(model().rigid_bodies.size(), Vec3::Zero());
  state.forces.rigid_torque.assign(model().rigid_bodies.size(), Vec3::Zero());
  for (std::size_t i = 0; i < n; ++i) {
    const Float4& a = accelerations_[i];
    state.forces.particle[i] =
        model().mass[i] *
        Vec3(static_cast<Real>(a.x), static_cast<Real>(a.y), static_cast<Real>(a.z));
  }
  state.forces_current = true;
  state.bound = model().damping.any ? find_bound_of_bodies(model()) : Oscillation{};
  if (!solids_) return;
  solids_->copy_to(state);
  if (model().damping.any) state.bound = solids_->bound();
}

void TaitMethod::copy(const TaitState& from, TaitState& to) {
  to.motion.copy_from(from.motion);
  program_.copy(from.acceleration, to.acceleration, model().liquid_count * sizeof(Float4));
}

void TaitMethod::save() {
  copy(now_, start_);
  if (solids_) solids_->save();
}

void TaitMethod::restore() {
  copy(start_, now_);
  if (solids_) solids_->restore();
}

void TaitMethod::evaluate_liquid(const LiquidParameters& p) {
  DeviceParticles& s = particles_;
  s.sort_after("move", p, now_.motion.position, now_.motion.velocity, now_.acceleration);
  program_.run("find_pressure", s.count(), p, s.cells.begins, s.sorted_place, s.sorted_motion,
               s.density, s.neighbour_counts, s.neighbours);
  s.find_solid_pressure(p);
  program_.run("find_acceleration", s.count(), p, s.cells.begins, s.order, s.sorted_place,
               s.sorted_motion, s.neighbour_counts, s.neighbours, now_.acceleration);
}

void TaitMethod::evaluate(const StepMoment& start, Real end) {
  StepMoment at_end = start;
  at_end.time = end;
  // No damping of the liquid needs a solve.
  at_end.prediction = model().damping.any ? start.opening : 0;
  const LiquidParameters p = geometry_.at(model(), at_end);
  if (solids_) solids_->move(start, end, model().scene.numerics.step, particles_.counters.buffer);
  evaluate_liquid(p);
  if (solids_) find_forces_on_solids(p, end);
}

void TaitMethod::find_forces_on_solids(const LiquidParameters& p, Real end) {
  DeviceParticles& s = particles_;
  solids_->find_forces(end);
  program_.run("add_forces_on_solids", s.count(), p, s.cells.begins, s.order, s.sorted_place,
               s.sorted_motion, s.neighbour_counts, s.neighbours, solids_->force());
  solids_->gather();
}

void TaitMethod::finish(const StepMoment& moment) {
  program_.run("finish", model().liquid_count, geometry_.at(model(), moment), now_.motion.position,
               now_.motion.velocity, now_.acceleration, particles_.counters.buffer);
  if (solids_) solids_->finish(moment, model().scene.numerics.step, particles_.counters.buffer);
}

}  // namespace

std::size_t bytes_for_tait(const Model& model) {
  const LiquidGeometry geometry(model, guard_bounds(model));
  const bool moves = solids_move(model);
  return DeviceParticles::bytes_for(model, geometry, moves) +
         2 * model.liquid_count * TaitState::kBytes + (moves ? DeviceSolids::bytes_for(model) : 0);
}

std::unique_ptr<DeviceMethod> make_tait_method(Program& program,
                                               std::shared_ptr<const Model> model) {
  const LiquidGeometry geometry(*model, guard_bounds(*model));
  return std::make_unique<TaitMethod>(program, std::move(model), geometry);
}

}  // namespace vat
