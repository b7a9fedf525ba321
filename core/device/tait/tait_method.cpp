#include "core/device/tait/tait_method.h"

#include <utility>
#include <vector>

#include "core/damping/damping_solve.h"
#include "core/device/common/device_motion.h"
#include "core/device/liquid/device_particles.h"

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

class TaitMethod : public DeviceMethod {
 public:
  TaitMethod(Program& program, std::shared_ptr<const Model> model, const LiquidGeometry& geometry)
      : program_(program),
        model_(std::move(model)),
        geometry_(geometry),
        particles_(program, *model_, geometry),
        now_(program, model_->liquid_count),
        start_(program, model_->liquid_count) {}

  bool take_steps(const EngineInput& input, std::uint32_t steps) override;
  void read(State& state) override;

 private:
  void upload(const State& state);
  void evaluate(const LiquidParameters& p);
  void copy(const TaitState& from, TaitState& to);

  Program& program_;
  const std::shared_ptr<const Model> model_;
  const LiquidGeometry geometry_;
  DeviceParticles particles_;
  TaitState now_;
  TaitState start_;  ///< state before a call, for a failed step
  ReadMotion read_;
  std::vector<Float4> accelerations_;
};

void TaitMethod::upload(const State& state) {
  const std::size_t n = model_->liquid_count;
  now_.motion.write(state.now);
  particles_.write_solids(state.now);
  accelerations_.assign(n, {});
  if (state.forces_current) {
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3 a = state.forces.particle[i] * model_->inverse_mass[i];
      accelerations_[i] = {static_cast<float>(a.x()), static_cast<float>(a.y()),
                           static_cast<float>(a.z()), 0};
    }
  }
  program_.write(now_.acceleration, std::span<const Float4>(accelerations_));
}

void TaitMethod::read(State& state) {
  const std::size_t n = model_->liquid_count;
  accelerations_.resize(n);
  read_.read(program_, now_.motion, n);
  program_.read(now_.acceleration, std::span<Float4>(accelerations_));
  read_.copy_to(state.now);
  // No force acts on the solids, which are held.
  state.forces.particle.assign(model_->particle_count, Vec3::Zero());
  state.forces.rigid_force.assign(model_->rigid_bodies.size(), Vec3::Zero());
  state.forces.rigid_torque.assign(model_->rigid_bodies.size(), Vec3::Zero());
  for (std::size_t i = 0; i < n; ++i) {
    const Float4& a = accelerations_[i];
    state.forces.particle[i] =
        model_->mass[i] *
        Vec3(static_cast<Real>(a.x), static_cast<Real>(a.y), static_cast<Real>(a.z));
  }
  state.forces_current = true;
  state.bound = model_->damping.any ? find_bound_of_bodies(*model_) : Oscillation{};
}

void TaitMethod::copy(const TaitState& from, TaitState& to) {
  to.motion.copy_from(from.motion);
  program_.copy(from.acceleration, to.acceleration, model_->liquid_count * sizeof(Float4));
}

/// Moves the particles, and computes their accelerations at the new positions.
void TaitMethod::evaluate(const LiquidParameters& p) {
  DeviceParticles& s = particles_;
  s.sort_after("move", p, now_.motion.position, now_.motion.velocity, now_.acceleration);
  program_.run("find_pressure", s.count(), p, s.cells.begins, s.sorted_place, s.sorted_motion,
               s.density, s.neighbour_counts, s.neighbours);
  s.find_solid_pressure(p);
  program_.run("find_acceleration", s.count(), p, s.cells.begins, s.order, s.sorted_place,
               s.sorted_motion, s.neighbour_counts, s.neighbours, now_.acceleration);
}

bool TaitMethod::take_steps(const EngineInput& input, std::uint32_t steps) {
  const State& state = input.state;
  const Real dt = model_->scene.numerics.step;
  if (!input.continues) upload(state);
  copy(now_, start_);
  particles_.counters.clear();
  std::uint32_t evaluations = steps;
  if (!input.continues && !state.forces_current) {
    const Real start = static_cast<Real>(state.step_count) * dt;
    evaluate(geometry_.at(*model_, {start, 0, 0, 0, 0}));
    ++evaluations;
  }
  StepMoment moment{0, 0, dt / 2, dt, model_->damping.any ? dt / 2 : 0};
  for (std::uint32_t s = 0; s < steps; ++s) {
    moment.time = static_cast<Real>(state.step_count + s) * dt + dt;
    evaluate(geometry_.at(*model_, moment));
    moment.closing = dt / 2;
  }
  program_.run("finish", model_->liquid_count, geometry_.at(*model_, moment), now_.motion.position,
               now_.motion.velocity, now_.acceleration, particles_.counters.buffer);
  const Counters counters = particles_.counters.read();
  if (counters.faults != 0) {
    copy(start_, now_);
    return false;
  }
  AdvanceReport& report = input.report;
  for (std::uint32_t e = 0; e < evaluations; ++e) report.count_evaluation(model_->particle_count);
  report.count_steps(steps, dt, dt);
  report.wall_stops += static_cast<std::uint64_t>(counters.stops);
  return true;
}

}  // namespace

std::size_t bytes_for_tait(const Model& model) {
  const LiquidGeometry geometry(model, guard_bounds(model));
  return DeviceParticles::bytes_for(model, geometry) + 2 * model.liquid_count * TaitState::kBytes;
}

std::unique_ptr<DeviceMethod> make_tait_method(Program& program,
                                               std::shared_ptr<const Model> model) {
  const LiquidGeometry geometry(*model, guard_bounds(*model));
  return std::make_unique<TaitMethod>(program, std::move(model), geometry);
}

}  // namespace vat
