#include "core/device/tait/tait_method.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/damping/damping_solve.h"
#include "core/device/common/device_motion.h"
#include "core/device/common/kernel_values.h"
#include "core/device/common/verlet_method.h"
#include "core/device/liquid/device_cohesion.h"
#include "core/device/liquid/device_particles.h"
#include "core/device/liquid/device_step_control.h"
#include "core/device/liquid/device_surface.h"
#include "core/device/solid/device_solids.h"
#include "core/device/tait/device_liquid_integration.h"
#include "core/device/tait/device_nozzles.h"
#include "core/device/tait/device_transport.h"
#include "core/device/tait/device_viscosity.h"
#include "core/stepping/integrator.h"
#include "core/stepping/runge_kutta.h"

namespace vat {
namespace {

using opencl::Buffer;
using opencl::Program;

/// The integrated variables, in the order of particles.
struct TaitState {
  TaitState(Program& program, const Model& model)
      : motion(program, model.liquid_count),
        acceleration(program, model.liquid_count * bytes_of_acceleration(model)) {}
  static std::size_t bytes_of_acceleration(const Model& model) { return 4 * bytes_of_real(model); }
  static std::size_t bytes_for(const Model& model) {
    return model.liquid_count * (DeviceMotion::kBytes + bytes_of_acceleration(model));
  }

  DeviceMotion motion;
  Buffer acceleration;
};

/// The data of adaptive steps.
struct AdaptiveSteps {
  AdaptiveSteps(Program& program, const Model& model)
      : partial(program, bytes_of_partial(model.liquid_count)),
        control(program, model, partial),
        before(program, model) {}
  static std::size_t bytes_for(const Model& model) {
    return bytes_of_partial(model.liquid_count) + DeviceStepControl::bytes_for(model) +
           TaitState::bytes_for(model);
  }

  Buffer partial;
  DeviceStepControl control;
  TaitState before;  ///< state at the start of a step
  StepHistory history;
  StepHistory saved_history;
};

bool is_adaptive(const Model& model) {
  return model.scene.numerics.control == StepControl::adaptive;
}

/// Returns whether steps can be too long for explicit viscosity.
bool has_viscosity_solve(const Model& model) {
  return !solids_move(model) &&
         (is_adaptive(model) || must_solve_viscosity(model, model.scene.numerics.step));
}

bool keeps_forces(const Model& model) {
  return integrator_of(model.scene.numerics.integrator).keeps_forces();
}

std::unique_ptr<DeviceSolids> make_solids(Program& program, const Model& model) {
  if (!solids_move(model)) return nullptr;
  return std::make_unique<DeviceSolids>(program, model, guard_bounds(model));
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
        now_(program, model()),
        start_(program, model()) {
    if (!keeps_forces(model())) integration_.emplace(program, model());
    if (is_adaptive(model())) adaptive_.emplace(program, model());
    if (model().has_surface_tension) surface_.emplace(program, model());
    if (model().cohesion) cohesion_.emplace(program, model());
    if (model().is_filled) transport_.emplace(program, model());
    if (has_viscosity_solve(model())) viscosity_.emplace(program, model());
    if (DeviceNozzles::has_particles(model())) nozzles_.emplace(program, model());
  }

  void read(State& state) override;

 private:
  DeviceCounters& counters() override { return particles_.counters; }
  void write(const State& state) override;
  void release(std::uint64_t step) override {
    if (solids_) solids_->release(step);
  }
  void save() override;
  void restore() override;
  void evaluate(const StepMoment& start, Real end) override;
  bool must_solve(Real dt) const override;
  std::uint32_t solve_damping(Real end, Real dt) override;
  void finish(const StepMoment& moment) override;
  void wrap_liquid() override { now_.motion.wrap_liquid(model()); }
  void count_work(AdvanceReport& report) override {
    if (solids_) solids_->count_work(report);
  }
  bool take_nominal_steps(const NominalSteps& steps, AdvanceReport& report) override;
  /// Takes a step of an integrator without a closing kick, from `start` to `end` [s].
  void integrate(Real start, Real end, Real dt, AdvanceReport& report);
  void copy(const TaitState& from, TaitState& to);
  /// Moves the liquid, and computes its accelerations.
  void evaluate_liquid(const LiquidParameters& p);
  /// Adds the forces between the liquid and moving solids to those of the solids.
  void find_forces_on_solids(const LiquidParameters& p, Real end);
  /// Takes and checks an adaptive step.
  bool take_part(const StepPart& part, AdvanceReport& report);
  Real find_allowed_step(Real start, AdvanceReport& report);
  /// Returns the rate of motion before the first step, as Stepper::probe_start(). Then the forces
  /// are those at `start`.
  Real probe_start(Real start, Real dt, AdvanceReport& report);
  /// Returns the rate of motion since the saved state `before`.
  Real observed_rate();

  Program& program_;
  const LiquidGeometry geometry_;
  const std::unique_ptr<DeviceSolids> solids_;  ///< null if all solids are at rest
  DeviceParticles particles_;
  TaitState now_;
  TaitState start_;  ///< state before a call, for a failed step
  std::optional<AdaptiveSteps> adaptive_;
  std::optional<DeviceLiquidIntegration> integration_;  ///< of integrators without a closing kick
  std::optional<DeviceSurface> surface_;
  std::optional<DeviceCohesion> cohesion_;
  std::optional<DeviceTransport> transport_;  ///< only if the liquid fills its world
  std::optional<DeviceNozzles> nozzles_;      ///< only if particles are in tubes
  std::optional<DeviceViscosity> viscosity_;  ///< only if a step may not resolve the viscosity
  ReadMotion read_;
  std::vector<double> accelerations_;  ///< four numbers for each particle
};

void TaitMethod::write(const State& state) {
  const std::size_t n = model().liquid_count;
  now_.motion.write(state.now);
  particles_.write_solids(state.now);
  if (solids_) solids_->write(state);
  if (transport_) transport_->write(state.forces);
  if (adaptive_) adaptive_->history = state.history;
  accelerations_.assign(4 * n, 0);
  if (state.forces_current) {
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3 a = state.forces.particle[i] * model().inverse_mass[i];
      for (int k = 0; k < 3; ++k) {
        accelerations_[4 * i + static_cast<std::size_t>(k)] = without_last_bits(a[k]);
      }
    }
  }
  write_reals(program_, now_.acceleration, accelerations_);
}

void TaitMethod::read(State& state) {
  const std::size_t n = model().liquid_count;
  accelerations_.resize(4 * n);
  read_.read(program_, now_.motion, n);
  read_reals(program_, now_.acceleration, accelerations_);
  if (solids_) solids_->read();
  if (transport_) transport_->read();
  read_.copy_to(state.now);
  // No force acts on solids that are held.
  state.forces.particle.assign(model().particle_count, Vec3::Zero());
  state.forces.rigid_force.assign(model().rigid_bodies.size(), Vec3::Zero());
  state.forces.rigid_torque.assign(model().rigid_bodies.size(), Vec3::Zero());
  for (std::size_t i = 0; i < n; ++i) {
    state.forces.particle[i] = model().mass[i] * Eigen::Map<const Vec3>(&accelerations_[4 * i]);
  }
  if (transport_) transport_->copy_to(state.forces);
  state.forces_current = keeps_forces(model()) && !releases_body(model(), state.step_count);
  if (adaptive_) state.history = adaptive_->history;
  state.bound = model().damping.any ? find_bound_of_bodies(model()) : Oscillation{};
  if (!solids_) return;
  solids_->copy_to(state);
  if (model().damping.any) state.bound = solids_->bound();
}

void TaitMethod::copy(const TaitState& from, TaitState& to) {
  to.motion.copy_from(from.motion);
  program_.copy(from.acceleration, to.acceleration,
                model().liquid_count * TaitState::bytes_of_acceleration(model()));
}

void TaitMethod::save() {
  copy(now_, start_);
  if (solids_) solids_->save();
  if (transport_) transport_->save();
  if (adaptive_) adaptive_->saved_history = adaptive_->history;
}

void TaitMethod::restore() {
  copy(start_, now_);
  if (solids_) solids_->restore();
  if (transport_) transport_->restore();
  if (adaptive_) adaptive_->history = adaptive_->saved_history;
}

bool TaitMethod::must_solve(Real dt) const {
  return solids_ ? solids_->must_solve(dt) : viscosity_ && must_solve_viscosity(model(), dt);
}

std::uint32_t TaitMethod::solve_damping(Real end, Real dt) {
  if (solids_) return solids_->solve_damping(end, dt);
  return viscosity_->solve(geometry_.at(model(), {end, 0, 0, 0, 0}), particles_,
                           now_.motion.velocity, dt, now_.acceleration);
}

void TaitMethod::evaluate_liquid(const LiquidParameters& p) {
  DeviceParticles& s = particles_;
  s.sort_after("move", p, now_.motion.position, now_.motion.velocity, now_.acceleration);
  s.run_over_pairs_in_lanes("find_pressure", p, s.cells.begins, s.sorted_place, s.columns,
                            s.selected, s.sorted_motion, s.density, s.neighbour_counts,
                            s.plain_counts, s.neighbours);
  s.find_solid_pressure(p);
  s.run_over_pairs_in_lanes("find_acceleration", p, s.cells.begins, s.order, s.sorted_place,
                            s.sorted_motion, s.neighbour_counts, s.plain_counts, s.neighbours,
                            now_.acceleration);
  if (surface_) surface_->add_forces(p, s, now_.acceleration);
  if (cohesion_) cohesion_->add_forces(p, s, now_.acceleration);
  if (transport_) transport_->add_forces(p, s, now_.acceleration);
  if (nozzles_) nozzles_->hold(now_.acceleration);
}

void TaitMethod::evaluate(const StepMoment& start, Real end) {
  StepMoment at_end = start;
  at_end.time = end;
  // No damping of the liquid needs a solve.
  at_end.prediction = model().damping.any ? start.opening : 0;
  const LiquidParameters p = geometry_.at(model(), at_end);
  if (solids_) solids_->move(start, end, model().scene.numerics.step, particles_.counters.buffer);
  if (transport_ && start.drift > 0) transport_->drift(start.drift, now_.motion.position);
  evaluate_liquid(p);
  if (solids_) find_forces_on_solids(p, end);
}

void TaitMethod::find_forces_on_solids(const LiquidParameters& p, Real end) {
  DeviceParticles& s = particles_;
  solids_->find_forces(end);
  s.add_forces_on_solids(p, solids_->force());
  if (cohesion_) cohesion_->add_forces_on_solids(p, s, solids_->force());
  solids_->gather();
}

void TaitMethod::finish(const StepMoment& moment) {
  LiquidParameters p = geometry_.at(model(), moment);
  p.greatest_speed2 = geometry_.greatest_speed2(2 * moment.closing);  // a kick lasts half a step
  program_.run("finish", model().liquid_count, p, now_.motion.position, now_.motion.velocity,
               now_.acceleration, particles_.counters.buffer);
  if (solids_) solids_->finish(moment, model().scene.numerics.step, particles_.counters.buffer);
}

Real TaitMethod::observed_rate() {
  const TaitState& before = adaptive_->before;
  return adaptive_->control.observed_rate(
      model(), {before.motion.position, now_.motion.position, before.acceleration,
                now_.acceleration, particles_.weight()});
}

Real TaitMethod::probe_start(Real start, Real dt, AdvanceReport& report) {
  evaluate_at_start(start, report);
  copy(now_, adaptive_->before);
  LiquidParameters moved = geometry_.at(model(), {start + dt, 0, dt / 2, dt, 0});
  remove_walls(moved);
  evaluate_liquid(moved);
  report.count_evaluation(model().particle_count);
  const Real rate = observed_rate();
  copy(adaptive_->before, now_);
  return rate;
}

Real TaitMethod::find_allowed_step(Real start, AdvanceReport& report) {
  const Real step =
      adaptive_->control.least_step_by_forces(model(), now_.motion.velocity, now_.acceleration);
  StepHistory& history = adaptive_->history;
  if (history.step == 0) {
    const Real nominal = model().scene.numerics.step;
    history.observed_rate = probe_start(start, kProbeShare * std::min(step, nominal), report);
  }
  return limit_by_rate(model(), step, history.observed_rate);
}

bool TaitMethod::take_part(const StepPart& part, AdvanceReport& report) {
  const Real dt = part.length;
  copy(now_, adaptive_->before);
  take_step({part.start, 0, dt / 2, dt, 0}, part.end, report);
  finish({part.end, dt / 2, 0, 0, 0});
  report.count_steps(1, dt, dt);
  if (particles_.counters.read().faults != 0) return false;
  adaptive_->history.observed_rate = observed_rate();
  return true;
}

void TaitMethod::integrate(Real start, Real end, Real dt, AdvanceReport& report) {
  const SteppedLiquid liquid{now_.motion, now_.acceleration,
                             transport_ ? &transport_->velocities() : nullptr};
  const LiquidParameters at_end = geometry_.at(model(), {end, 0, 0, 0, 0});
  const Buffer& counters = particles_.counters.buffer;
  const std::span<const RungeKuttaStage> stages =
      runge_kutta_stages(model().scene.numerics.integrator);
  std::size_t stage = 0;
  // The liquid reaches a stage before the forces on the liquid and the solids are evaluated.
  const auto evaluate = [&](Real time) {
    if (stage > 0) {
      integration_->advance(stages[stage - 1].weight, stages[stage].reach * dt, liquid);
    }
    evaluate_at_start(time, report);
    ++stage;
  };
  if (!stages.empty()) integration_->begin(liquid);
  if (solids_) {
    solids_->integrate(start, end, dt, counters, evaluate);
  } else if (stages.empty()) {
    evaluate(start);
  } else {
    for (const RungeKuttaStage& one : stages) evaluate(start + one.reach * dt);
  }
  if (stages.empty()) {
    integration_->take_euler_step(at_end, dt, liquid, counters);
  } else {
    integration_->advance(stages.back().weight, 0, liquid);
    integration_->end(at_end, dt, liquid, counters);
  }
}

bool TaitMethod::take_nominal_steps(const NominalSteps& steps, AdvanceReport& report) {
  if (integration_) {
    for (std::uint32_t s = 0; s < steps.count; ++s) {
      integrate(steps.time(s), steps.time(s + 1), steps.step, report);
      wrap_liquid();
    }
    report.count_steps(steps.count, steps.step, steps.step);
    // Springs change before walls stop their particles.
    return !solids_ || !solids_->springs_change() || particles_.counters.read().stops == 0;
  }
  if (!adaptive_) return VerletMethod::take_nominal_steps(steps, report);
  StepHistory& history = adaptive_->history;
  bool has_forces = steps.has_forces;
  bool is_valid = true;
  for (std::uint32_t s = 0; s < steps.count && is_valid; ++s) {
    is_valid = take_varied_step(
        {steps.time(s), steps.time(s + 1), steps.step}, history,
        [&](Real start) {
          has_forces = has_forces || history.step == 0;  // after the probe
          return find_allowed_step(start, report);
        },
        [&](const StepPart& part) {
          if (!has_forces) evaluate_at_start(part.start, report);
          has_forces = true;
          return take_part(part, report);
        });
    wrap_liquid();
  }
  return is_valid;
}

}  // namespace

std::size_t bytes_for_tait(const Model& model) {
  const LiquidGeometry geometry(model, guard_bounds(model));
  const bool moves = solids_move(model);
  return DeviceParticles::bytes_for(model, geometry, moves) + 2 * TaitState::bytes_for(model) +
         DeviceNozzles::bytes_for(model) +
         (keeps_forces(model) ? 0 : DeviceLiquidIntegration::bytes_for(model)) +
         (is_adaptive(model) ? AdaptiveSteps::bytes_for(model) : 0) +
         (model.has_surface_tension ? DeviceSurface::bytes_for(model) : 0) +
         (model.cohesion ? DeviceCohesion::bytes_for(model) : 0) +
         (model.is_filled ? DeviceTransport::bytes_for(model) : 0) +
         (has_viscosity_solve(model) ? DeviceViscosity::bytes_for(model) : 0) +
         (moves ? DeviceSolids::bytes_for(model) : 0);
}

std::unique_ptr<DeviceMethod> make_tait_method(Program& program,
                                               std::shared_ptr<const Model> model) {
  const LiquidGeometry geometry(*model, guard_bounds(*model));
  return std::make_unique<TaitMethod>(program, std::move(model), geometry);
}

}  // namespace vat
