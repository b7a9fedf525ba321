#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/limits.h"
#include "core/numerics/choose_numerics.h"
#include "core/validation/validate_parts.h"

namespace vat {
namespace {

bool repeats(const Scene& scene, std::size_t axis) {
  return scene.periodic && scene.periodic->axes[axis];
}

/// The reason why this wall does not exist; null if it exists.
const char* why_absent(const Scene& scene, std::size_t wall) {
  const std::size_t axis = wall / 2;
  if (wall == 5 && !scene.vat->lid) return "must be left out: the vat has no lid";
  if (repeats(scene, axis)) return "must be left out: there are no walls across a periodic axis";
  if (scene.dimensions == 2 && axis == 1) {
    return "must be left out: there are no walls along the plane of two dimensions";
  }
  return nullptr;
}

void check_wall(const Scene& scene, std::size_t wall, RangeCheck& check) {
  const auto& [no_slip, velocity] = scene.vat->walls[wall];
  if (!no_slip && velocity.isZero(0)) return;
  const std::string path = std::string("/vat/walls/") + kWallNames[wall];
  if (const char* reason = why_absent(scene, wall)) {
    check.add("not_allowed", path, reason);
    return;
  }
  const std::string at = path + "/velocity";
  if (!check.vector(velocity, -kMaxSpeed, kMaxSpeed, at)) return;
  const std::size_t axis = wall / 2;
  if (velocity[static_cast<Eigen::Index>(axis)] != 0) {
    check.add("out_of_range", at,
              std::string("must be along the wall, with ") + kAxisNames[axis] + " = 0");
  }
}

/// Along periodic axes a vat has no walls, and its box must be that of the world.
void check_vat_in_periodic(const Vat& vat, const Periodicity& periodic, RangeCheck& check) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<Eigen::Index>(axis);
    if (!periodic.axes[axis]) continue;
    const std::string along = std::string(" along the periodic axis ") + kAxisNames[axis];
    if (vat.min[a] != periodic.min[a]) {
      check.add("out_of_range", "/vat/min", "must equal the min of \"periodic\"" + along);
    }
    if (vat.max[a] != periodic.max[a]) {
      check.add("out_of_range", "/vat/max", "must equal the max of \"periodic\"" + along);
    }
    if (vat.motion && vat.motion->axis[a] != 0) {
      check.add("not_allowed", "/vat/motion/axis", "must be 0" + along);
    }
  }
}

}  // namespace

void check_vat(const Scene& scene, RangeCheck& check) {
  const Vat& vat = *scene.vat;
  const bool min = check.vector(vat.min, -kMaxLength, kMaxLength, "/vat/min");
  const bool max = check.vector(vat.max, -kMaxLength, kMaxLength, "/vat/max");
  if (min && max && !((vat.max - vat.min).array() >= kMinLength).all()) {
    check.add("out_of_range", "/vat/max", "must be above min along every axis");
  }
  if (vat.motion) check_slide(*vat.motion, "/vat/motion", check);
  for (std::size_t wall = 0; wall < vat.walls.size(); ++wall) check_wall(scene, wall, check);
  if (scene.periodic && min && max) check_vat_in_periodic(vat, *scene.periodic, check);
}

void check_periodicity(const Periodicity& periodic, RangeCheck& check) {
  if (std::ranges::count(periodic.axes, true) == 0) {
    check.add("out_of_range", "/periodic/axes", "must name one axis or more");
  }
  const bool min = check.vector(periodic.min, -kMaxLength, kMaxLength, "/periodic/min");
  const bool max = check.vector(periodic.max, -kMaxLength, kMaxLength, "/periodic/max");
  if (!min || !max) return;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<Eigen::Index>(axis);
    if (!periodic.axes[axis] || periodic.max[a] - periodic.min[a] >= kMinLength) continue;
    check.add("out_of_range", "/periodic/max",
              std::string("must be above min along ") + kAxisNames[axis]);
  }
}

void check_central_field(const CentralField& field, RangeCheck& check) {
  check.vector(field.center, -kMaxLength, kMaxLength, "/central_field/center");
  check.real(field.angular_frequency, 0, kMaxAngularSpeed, "/central_field/angular_frequency");
}

void check_settling(const Settling& settling, RangeCheck& check) {
  check.real(settling.drag, 0, kMaxDrag, "/settling/drag");
  check.real(settling.until, 0, kMaxRelease, "/settling/until");
}

void check_sleeping(const Sleeping& sleeping, RangeCheck& check) {
  check.real(sleeping.speed, kMinSleepSpeed, kMaxSleepSpeed, "/sleeping/speed");
  check.real(sleeping.after, kMinStep, kMaxSleepAfter, "/sleeping/after");
}

void check_numerics(const Scene& scene, RangeCheck& check) {
  const Numerics& numerics = scene.numerics;
  constexpr Real kWhole = 1e-9;  // rounding of tick / step
  const bool tick = check.real(numerics.tick, kMinStep, kMaxTick, "/numerics/tick");
  if (numerics.accuracy) {
    check.real(*numerics.accuracy, kMinAccuracy, kMaxAccuracy, "/numerics/accuracy");
    return;
  }
  check.real(numerics.tolerance, kMinAccuracy, kMaxTolerance, "/numerics/tolerance");
  if (numerics.control == StepControl::local &&
      scene.pressure_solver != PressureSolver::incompressible &&  // has its own integrator
      numerics.integrator != IntegratorId::velocity_verlet) {
    check.add("not_allowed", "/numerics/control",
              std::string("\"local\" needs the integrator \"velocity_verlet\", not \"") +
                  to_string(numerics.integrator) + '"');
  }
  const bool step = check.real(numerics.step, kMinStep, kMaxStep, "/numerics/step");
  if (!step || !tick) return;
  const Real steps = numerics.tick / numerics.step;
  const Real whole = std::round(steps);
  if (whole < 1 || whole > static_cast<Real>(kMaxStepsPerTick) ||
      std::abs(steps - whole) > kWhole * steps) {
    check.add("out_of_range", "/numerics/tick",
              "must be a whole number of steps, 1 to " + std::to_string(kMaxStepsPerTick));
  }
}

void check_accuracy(const Scene& scene, const std::vector<SampledBody>& samples,
                    RangeCheck& check) {
  if (!scene.numerics.accuracy) return;
  const Numerics chosen = choose_numerics(scene, pointers_to(samples));
  if (chosen.step >= kMinStep &&
      chosen.tick <= chosen.step * (static_cast<Real>(kMaxStepsPerTick) + 0.5)) {
    return;
  }
  std::ostringstream message;
  message << "needs steps of " << chosen.step << " s: they must be at least " << kMinStep
          << " s, and at most " << kMaxStepsPerTick << " in a tick";
  check.add("out_of_range", "/numerics/accuracy", message.str());
}

}  // namespace vat
