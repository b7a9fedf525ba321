#include "core/device/incompressible/incompressible_method.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "core/damping/damping_solve.h"
#include "core/device/common/device_motion.h"
#include "core/device/common/verlet_method.h"
#include "core/device/incompressible/device_solve.h"
#include "core/device/incompressible/viscous_liquid.h"
#include "core/device/incompressible/wet_solids.h"
#include "core/device/liquid/device_particles.h"
#include "core/device/liquid/device_step_control.h"
#include "core/liquid/incompressible/solve_limits.h"
#include "core/stepping/control/step_control.h"
#include "core/support/check.h"

namespace vat {
namespace {

using opencl::Buffer;
using opencl::Program;

// The argument is_held of the kernel `place`.
constexpr std::int32_t kNotHeld = 0;
constexpr std::int32_t kHeld = 1;

/// The integrated variables, in the order of particles.
struct IncompressibleState {
  IncompressibleState(Program& program, std::size_t n)
      : motion(program, n), pressure(program, n * sizeof(double)) {}
  static constexpr std::size_t kBytes = DeviceMotion::kBytes + sizeof(double);

  DeviceMotion motion;
  Buffer pressure;
};

bool is_adaptive(const Model& model) {
  return model.scene.numerics.control == StepControl::adaptive;
}

/// Returns whether a step can be too long for explicit viscosity.
bool needs_viscosity_solve(const Model& model) {
  const Real longest =
      is_adaptive(model) ? longest_adaptive_step(model) : model.scene.numerics.step;
  return !solids_move(model) && must_solve_own_damping(model, longest);
}

/// Steps of symplectic Euler, as Stepper::take_step(). Cells, neighbours and densities are those
/// of the present positions at the start of each step.
class IncompressibleMethod : public DeviceMethod {
 public:
  IncompressibleMethod(Program& program, std::shared_ptr<const Model> model,
                       const LiquidGeometry& geometry)
      : program_(program),
        model_(std::move(model)),
        geometry_(geometry),
        parameters_(solve_parameters(*model_)),
        wet_(solids_move(*model_) ? std::make_unique<WetSolids>(program, *model_) : nullptr),
        particles_(program, *model_, geometry, moving_particles(wet_ ? &wet_->solids : nullptr)),
        solve_(program, *model_),
        now_(program, model_->liquid_count),
        start_(program, model_->liquid_count) {
    if (is_adaptive(*model_)) control_.emplace(program, *model_, solve_.partial);
    if (needs_viscosity_solve(*model_)) viscous_.emplace(program, *model_);
  }

  bool take_steps(const EngineInput& input, std::uint32_t steps) override;
  void read(State& state) override;

 private:
  void upload(const State& state);
  /// Saves the present state, or returns to the saved one.
  void save();
  void restore();
  void copy(const IncompressibleState& from, IncompressibleState& to);
  /// Enters the particles into their cells by the kernel `name`, and finds their neighbours and
  /// densities.
  template <class... Arguments>
  void find_density_after(const char* name, const LiquidParameters& p, const Arguments&... own);
  /// Finds the densities of the present positions at `time`.
  void find_density_at(Real time);
  void find_acceleration(const LiquidParameters& p, const Buffer& acceleration);
  /// Finds the densities and the forces on solids at the start of a step. Kicks the solids.
  void begin_step_of_solids(const StepPart& step);
  /// Returns whether the state after the step is valid.
  bool take_step(const StepPart& step, AdvanceReport& report);
  void project_velocities(const StepPart& step, AdvanceReport& report);
  /// Changes the velocities by the forces.
  void kick(const LiquidParameters& p, const SolveParameters& solve, AdvanceReport& report);
  void correct_density(LiquidParameters p);
  /// Takes a nominal step. Returns whether the state is valid.
  bool take_nominal_step(const StepPart& nominal, AdvanceReport& report);
  Real find_allowed_step(Real start, AdvanceReport& report);
  /// Returns the rate of motion before the first step, as Stepper::probe_start().
  Real probe_start(Real start, Real dt);

  Program& program_;
  const std::shared_ptr<const Model> model_;
  const LiquidGeometry geometry_;
  const SolveParameters parameters_;
  const std::unique_ptr<WetSolids> wet_;  ///< null if all solids are at rest
  DeviceParticles particles_;
  DeviceSolve solve_;
  IncompressibleState now_;
  IncompressibleState start_;                 ///< state before a call, for a failed step
  std::optional<DeviceStepControl> control_;  ///< only with adaptive steps
  StepHistory history_, saved_history_;
  std::optional<ViscousLiquid> viscous_;  ///< only if a step may not resolve the viscosity
  VolumeReport report_, saved_report_;    ///< of the last step
  int shift_iterations_ = 0;              ///< of the last solve for positions
  ReadMotion read_;
  std::vector<Real> pressures_;
};

void IncompressibleMethod::upload(const State& state) {
  VAT_CHECK(state.now.pressure.size() == model_->liquid_count);
  now_.motion.write(state.now);
  particles_.write_solids(state.now);
  program_.write(now_.pressure, std::span<const Real>(state.now.pressure));
  report_ = state.volume;
  history_ = state.history;
  if (wet_) wet_->write(state);
}

void IncompressibleMethod::read(State& state) {
  const std::size_t n = model_->liquid_count;
  pressures_.resize(n);
  read_.read(program_, now_.motion, n);
  program_.read(now_.pressure, std::span(pressures_));
  if (wet_) wet_->solids.read();
  read_.copy_to(state.now);
  state.now.pressure.swap(pressures_);
  state.volume = report_;
  state.history = history_;
  if (!wet_) return;
  state.forces.particle.resize(model_->particle_count);
  wet_->solids.copy_to(state);
}

void IncompressibleMethod::save() {
  copy(now_, start_);
  saved_report_ = report_;
  saved_history_ = history_;
  if (wet_) wet_->solids.save();
}

void IncompressibleMethod::restore() {
  copy(start_, now_);
  report_ = saved_report_;
  history_ = saved_history_;
  if (wet_) wet_->solids.restore();
}

void IncompressibleMethod::copy(const IncompressibleState& from, IncompressibleState& to) {
  to.motion.copy_from(from.motion);
  program_.copy(from.pressure, to.pressure, model_->liquid_count * sizeof(double));
}

template <class... Arguments>
void IncompressibleMethod::find_density_after(const char* name, const LiquidParameters& p,
                                              const Arguments&... own) {
  DeviceParticles& s = particles_;
  s.sort_after(name, p, own...);
  program_.run_in_lanes("find_density", s.count(), p, s.cells.begins, s.order, now_.pressure,
                        s.sorted_place, s.columns, s.selected, s.sorted_motion, s.neighbour_counts,
                        s.plain_counts, s.neighbours, s.density, solve_.squares, solve_.partial);
}

void IncompressibleMethod::find_density_at(Real time) {
  find_density_after("place", geometry_.at(*model_, {time, 0, 0, 0, 0}), kNotHeld,
                     now_.motion.position, now_.motion.velocity);
}

void IncompressibleMethod::find_acceleration(const LiquidParameters& p,
                                             const Buffer& acceleration) {
  DeviceParticles& s = particles_;
  s.find_solid_pressure(p);
  program_.run_in_lanes("find_acceleration", s.count(), p, s.cells.begins, s.order, s.sorted_place,
                        s.sorted_motion, s.neighbour_counts, s.plain_counts, s.neighbours,
                        acceleration);
}

void IncompressibleMethod::kick(const LiquidParameters& p, const SolveParameters& solve,
                                AdvanceReport& report) {
  DeviceParticles& s = particles_;
  if (!viscous_ || !must_solve_own_damping(*model_, solve.dt)) {
    LiquidParameters without = p;
    for (double& g : without.gravity) g = 0;
    program_.run_in_lanes("kick", s.count(), without, solve, s.cells.begins, s.order,
                          s.sorted_place, s.sorted_motion, s.neighbour_counts, s.plain_counts,
                          s.neighbours, now_.motion.velocity, solve_.solve_motion);
    return;
  }
  report.iterations.damping +=
      viscous_->kick(p, solve, s, now_.motion.velocity, solve_.solve_motion);
}

void IncompressibleMethod::begin_step_of_solids(const StepPart& step) {
  const LiquidParameters p = geometry_.at(*model_, {step.start, 0, 0, 0, 0});
  wet_->solids.move({step.start, 0, 0, 0, 0}, step.start, step.length, particles_.counters.buffer);
  // Walls have moved solids since the last densities, and their velocities have changed.
  find_density_at(step.start);
  particles_.find_solid_pressure(p);
  wet_->find_forces(step.start, p, particles_);
  wet_->solids.kick_euler_step(step.length);
}

void IncompressibleMethod::project_velocities(const StepPart& step, AdvanceReport& report) {
  const LiquidParameters p = geometry_.at(*model_, {step.start, 0, 0, 0, 0});
  DeviceParticles& s = particles_;
  const std::size_t n = s.count();
  if (wet_) {
    begin_step_of_solids(step);
  } else {
    s.find_solid_pressure(p);
  }
  SolveParameters solve = parameters_;
  solve.dt = step.length;
  solve.solids_move = wet_ ? 1 : 0;
  const Vec3 wall_velocity = mean_wall_velocity(*model_, step.start, step.length);
  for (int k = 0; k < 3; ++k) {
    solve.wall_velocity[k] = wall_velocity[k];
    solve.gravity[k] = model_->scene.forces.gravity ? model_->scene.gravity[k] : 0;
  }
  set_limits(velocity_limits(model_->scene.incompressible), solve);
  kick(p, solve, report);
  if (wet_) wet_->pushes.see_solids(p, solve, s, solve_.solve_motion, solve_.squares);
  program_.run_in_lanes("begin_projection", n, p, solve, s.cells.begins, s.order, s.sorted_place,
                        s.neighbour_counts, s.plain_counts, s.neighbours, solve_.solve_motion,
                        s.density, solve_.squares, now_.pressure, solve_.x, solve_.excess,
                        solve_.gradient, solve_.whole, solve_.partial);
  report_.velocities =
      solve_.solve(p, solve, s, wet_ ? &wet_->pushes : nullptr, report_.velocities.iterations);
  program_.run("end_projection", n, solve, solve_.progress, s.order, particles_.density, solve_.x,
               solve_.whole, now_.pressure, now_.motion.velocity);
  if (wet_) wet_->pushes.kick(solve, solve_.progress);
}

void IncompressibleMethod::correct_density(LiquidParameters p) {
  const std::size_t n = particles_.count();
  const IncompressibleSolve& wanted = model_->scene.incompressible;
  SolveReport& report = report_.places;
  int iterations = 0;
  for (int round = 0;; ++round) {
    find_density_after("place", p, kHeld, now_.motion.position, now_.motion.velocity);
    p.drift = 0;
    report = solve_.measure_excess();
    report.iterations = iterations;
    if (is_solved(wanted, report) || round == kMaxCorrections) return;
    SolveParameters solve = parameters_;
    solve.dt = 1;  // shifts take no time
    set_limits(place_limits(wanted, report.mean <= wanted.density_tolerance), solve);
    if (wet_) {
      wet_->pushes.see_solids(p, solve, particles_, solve_.solve_motion, solve_.squares);
    }
    program_.run("begin_shift", n, solve, particles_.sorted_place, particles_.density,
                 solve_.squares, solve_.x, solve_.excess, solve_.gradient, solve_.whole,
                 solve_.partial);
    shift_iterations_ = solve_.solve(p, solve, particles_, nullptr, shift_iterations_).iterations;
    iterations += shift_iterations_;
    program_.run("shift_places", n, solve, particles_.order, solve_.whole, now_.motion.position);
  }
}

bool IncompressibleMethod::take_step(const StepPart& step, AdvanceReport& report) {
  const Buffer& counters = particles_.counters.buffer;
  project_velocities(step, report);
  if (wet_) wet_->solids.drift_euler_step(step.start, step.end, step.length, counters);
  LiquidParameters p = geometry_.at(*model_, {step.end, 0, 0, step.length, 0});
  p.greatest_speed2 = geometry_.greatest_speed2(step.length);
  correct_density(p);
  program_.run("check", model_->liquid_count, p, now_.motion.position, now_.motion.velocity,
               counters);
  if (wet_) wet_->solids.end_euler_step(step.end, step.length, counters);
  report.iterations.velocities += static_cast<std::uint64_t>(report_.velocities.iterations);
  report.iterations.places += static_cast<std::uint64_t>(report_.places.iterations);
  report.count_evaluation(model_->particle_count);
  report.count_steps(1, step.length, step.length);
  return particles_.counters.read().faults == 0;
}

Real IncompressibleMethod::probe_start(Real start, Real dt) {
  const LiquidParameters p = geometry_.at(*model_, {start, 0, 0, 0, 0});
  LiquidParameters moved = geometry_.at(*model_, {start + dt, 0, dt / 2, dt, 0});
  remove_walls(moved);
  const Buffer& before = solve_.whole;
  const Buffer& after = solve_.solve_motion;
  if (wet_) find_density_at(start);
  find_acceleration(p, before);
  if (wet_) {
    wet_->find_forces(start, p, particles_);
    wet_->solids.probe(start, dt, particles_.counters.buffer);
  }
  find_density_after("move", moved, now_.motion.position, now_.motion.velocity, before);
  find_acceleration(moved, after);
  const Real rate = control_->observed_rate(
      *model_, {start_.motion.position, now_.motion.position, before, after, particles_.weight()});
  copy(start_, now_);
  particles_.counters.clear();
  if (wet_) {
    wet_->solids.restore();
  } else {
    find_density_at(start);
  }
  return rate;
}

Real IncompressibleMethod::find_allowed_step(Real start, AdvanceReport& report) {
  const Real nominal = model_->scene.numerics.step;
  const Real last = history_.step;
  Real step = control_->least_step(*model_, now_.motion.velocity, now_.pressure);
  if (wet_) {
    wet_->solids.place(start, particles_.counters.buffer);
    const Real longest = last > 0 ? std::min(nominal, 2 * last) : nominal;
    step = std::min(step,
                    wet_->limits->least_step(*model_, start, longest, control_->greatest_speed()));
  }
  if (last == 0) {
    history_.observed_rate = probe_start(start, kProbeShare * std::min(step, nominal));
    report.count_evaluation(model_->particle_count);
    report.count_evaluation(model_->particle_count);
  }
  return limit_by_rate(*model_, step, history_.observed_rate);
}

bool IncompressibleMethod::take_nominal_step(const StepPart& nominal, AdvanceReport& report) {
  if (!control_) return take_step(nominal, report);
  return take_varied_step(
      nominal, history_, [&](Real start) { return find_allowed_step(start, report); },
      [&](const StepPart& part) {
        if (!take_step(part, report)) return false;
        history_.observed_rate = 0;  // a step has one evaluation
        return true;
      });
}

bool IncompressibleMethod::take_steps(const EngineInput& input, std::uint32_t steps) {
  const State& state = input.state;
  const Real dt = model_->scene.numerics.step;
  const auto time = [&](std::uint32_t s) { return static_cast<Real>(state.step_count + s) * dt; };
  particles_.counters.clear();
  if (!input.continues) {
    upload(state);
    if (!wet_) find_density_at(time(0));
  }
  save();
  AdvanceReport report = input.report;
  bool is_sound = true;
  for (std::uint32_t s = 0; s < steps && is_sound; ++s) {
    const std::uint64_t step = state.step_count + s;
    if (wet_ && releases_body(*model_, step)) wet_->release(step);
    is_sound = take_nominal_step({time(s), time(s + 1), dt}, report);
    now_.motion.wrap_liquid(*model_);
  }
  if (!is_sound) {
    restore();
    return false;
  }
  if (wet_) wet_->solids.count_work(report);
  report.wall_stops += static_cast<std::uint64_t>(particles_.counters.read().stops);
  input.report = std::move(report);
  return true;
}

}  // namespace

std::size_t bytes_for_incompressible(const Model& model) {
  const LiquidGeometry geometry(model, guard_bounds(model));
  const bool moves = solids_move(model);
  return DeviceParticles::bytes_for(model, geometry, moves) + DeviceSolve::bytes_for(model) +
         DeviceStepControl::bytes_for(model) +
         2 * model.liquid_count * IncompressibleState::kBytes +
         (moves ? WetSolids::bytes_for(model) : 0) +
         (needs_viscosity_solve(model) ? ViscousLiquid::bytes_for(model) : 0);
}

std::unique_ptr<DeviceMethod> make_incompressible_method(Program& program,
                                                         std::shared_ptr<const Model> model) {
  const LiquidGeometry geometry(*model, guard_bounds(*model));
  return std::make_unique<IncompressibleMethod>(program, std::move(model), geometry);
}

}  // namespace vat
