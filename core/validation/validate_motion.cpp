#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/limits.h"
#include "core/validation/validate_parts.h"

namespace vat {
namespace {

constexpr Real kUnitTolerance = 1e-3;  // of a quaternion's length: rounding in files

void check_field(const VectorField& field, Real bound, const std::string& path, RangeCheck& check) {
  check.vector(field.center, -kMaxLength, kMaxLength, path + "/center");
  for (Eigen::Index row = 0; row < 3; ++row) {
    check.vector(field.gradient.row(row).transpose(), -kMaxGradient, kMaxGradient,
                 path + "/gradient/" + std::to_string(row));
  }
  if (field.waves.size() > kMaxWaves) {
    check.add("too_many", path + "/waves", "at most " + std::to_string(kMaxWaves) + " waves");
  }
  for (std::size_t w = 0; w < field.waves.size(); ++w) {
    const PlaneWave& wave = field.waves[w];
    const std::string at = path + "/waves/" + std::to_string(w);
    check.vector(wave.amplitude, -bound, bound, at + "/amplitude");
    check.vector(wave.wave_vector, -kMaxWaveNumber, kMaxWaveNumber, at + "/wave_vector");
    check.real(wave.phase, -kMaxPhase, kMaxPhase, at + "/phase");
  }
}

void check_fields(const BodyDescription& body, const std::string& path, RangeCheck& check) {
  const auto check_one = [&](const std::optional<VectorField>& field, Real bound,
                             const std::string& at) {
    if (!field) return;
    if (body.kind == BodyKind::rigid) {
      check.add("not_allowed", at, "must be left out for a rigid body");
    } else {
      check_field(*field, bound, at, check);
    }
  };
  check_one(body.velocity_field, kMaxSpeed, path + "/velocity_field");
  check_one(body.displacement_field, kMaxLength, path + "/displacement_field");
}

void check_jitter(const BodyDescription& body, const std::string& path, RangeCheck& check) {
  if (!check.real(body.jitter, 0, kMaxJitter, path + "/jitter") || body.jitter == 0) return;
  if (body.kind == BodyKind::rigid) {
    check.add("not_allowed", path + "/jitter", "must be 0 for a rigid body");
  } else if (body.spacing == 0) {
    check.add("missing", path + "/spacing", "must be given, since the jitter is in spacings");
  }
}

void check_hold(const BodyDescription& body, const std::string& path, RangeCheck& check) {
  check.real(body.sub_steps, 1, kMaxSubSteps, path + "/sub_steps");
  if (!check.real(body.release, 0, kMaxRelease, path + "/release")) return;
  constexpr const char* kRigidOnly = "only a rigid body can be held";
  const bool is_rigid = body.kind == BodyKind::rigid;
  if (body.fixed && !is_rigid) check.add("not_allowed", path + "/fixed", kRigidOnly);
  if (body.release > 0 && !is_rigid) {
    check.add("not_allowed", path + "/release", kRigidOnly);
  } else if (body.release > 0 && body.fixed) {
    check.add("not_allowed", path + "/release", "must be 0: a fixed body is never released");
  }
}

/// Checks that a guided body is rigid, and that its first velocity is zero.
void check_guided(const BodyDescription& body, const std::string& path, const char* member,
                  RangeCheck& check) {
  if (body.kind != BodyKind::rigid) {
    check.add("not_allowed", path + member, "only a rigid body has one");
  }
  if (!body.velocity.isZero(0)) {
    check.add("not_allowed", path + "/velocity",
              std::string("must be 0, since the body has \"") + (member + 1) + '"');
  }
}

void check_drive(const BodyDescription& body, const std::string& path, RangeCheck& check) {
  check_slide(*body.motion, path + "/motion", check);
  check_guided(body, path, "/motion", check);
  if (body.fixed) check.add("not_allowed", path + "/fixed", "must be false: the body is driven");
  if (body.release > 0) {
    check.add("not_allowed", path + "/release", "must be 0: a driven body is never released");
  }
  if (body.axle) check.add("not_allowed", path + "/axle", "a driven body has none");
}

void check_axle(const BodyDescription& body, const std::string& path, RangeCheck& check) {
  const Axle& axle = *body.axle;
  check_guided(body, path, "/axle", check);
  check.real(axle.damping, 0, kMaxDamping, path + "/axle/damping");
  if (body.fixed) check.add("not_allowed", path + "/fixed", "must be false: the body has an axle");
  const std::string at = path + "/axle/direction";
  if (!check.vector(axle.direction, -kMaxLength, kMaxLength, at)) return;
  if (axle.direction.norm() < kMinLength) {
    check.add("out_of_range", at, "must not be the zero vector");
    return;
  }
  constexpr Real kRounding = 1e-6;
  const Vec3& spin = body.angular_velocity;
  if (spin.cross(axle.direction.normalized()).norm() > kRounding * spin.norm()) {
    check.add("out_of_range", path + "/angular_velocity", "must be along the axle");
  }
}

}  // namespace

void check_slide(const SlideMotion& motion, const std::string& path, RangeCheck& check) {
  if (check.vector(motion.axis, -kMaxLength, kMaxLength, path + "/axis") &&
      motion.axis.norm() < kMinLength) {
    check.add("out_of_range", path + "/axis", "must not be the zero vector");
  }
  const bool stroke = check.real(motion.stroke, -kMaxLength, kMaxLength, path + "/stroke");
  const bool period = check.real(motion.period, kMinPeriod, kMaxPeriod, path + "/period");
  if (stroke && period && std::numbers::pi * std::abs(motion.stroke) / motion.period > kMaxSpeed) {
    check.add("out_of_range", path + "/period", "is too short: the motion would pass 10000 m/s");
  }
}

void check_motion(const BodyDescription& body, const std::string& path, RangeCheck& check) {
  check.vector(body.position, -kMaxLength, kMaxLength, path + "/position");
  check.vector(body.velocity, -kMaxSpeed, kMaxSpeed, path + "/velocity");
  check.vector(body.angular_velocity, -kMaxAngularSpeed, kMaxAngularSpeed,
               path + "/angular_velocity");
  if (!(std::abs(body.orientation.norm() - 1) <= kUnitTolerance)) {
    check.add("out_of_range", path + "/orientation",
              "must be a quaternion [w, x, y, z] of length 1 (within 0.001)");
  }
  check_fields(body, path, check);
  check_jitter(body, path, check);
  check_hold(body, path, check);
  if (body.motion) check_drive(body, path, check);
  if (body.axle) check_axle(body, path, check);
}

void check_start(const BodyDescription& body, const SampledBody& sample, const std::string& path,
                 RangeCheck& check) {
  const auto exceeds = [](const std::vector<Vec3>& values, Real bound) {
    return std::ranges::any_of(values, [&](const Vec3& v) { return !(v.norm() <= bound); });
  };
  if (body.velocity_field && exceeds(sample.velocities, kMaxSpeed)) {
    check.add("out_of_range", path + "/velocity_field",
              "is too strong: the body's particles may start with at most 10000 m/s");
  }
  if (body.displacement_field && exceeds(sample.positions, kMaxLength)) {
    check.add("out_of_range", path + "/displacement_field",
              "is too strong: particles may start at most 1000000 m from the origin");
  }
}

}  // namespace vat
