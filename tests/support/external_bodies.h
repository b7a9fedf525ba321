#pragma once

#include <Eigen/Eigenvalues>
#include <cmath>
#include <cstring>
#include <vector>

#include "core/coupling/external_body.h"

/// External simulators for tests of the coupling.
namespace vat::test {

/// Returns numbers as bytes, for ExternalBody::save().
inline std::vector<std::uint8_t> to_saved(const std::vector<Real>& numbers) {
  std::vector<std::uint8_t> bytes(numbers.size() * sizeof(Real));
  std::memcpy(bytes.data(), numbers.data(), bytes.size());
  return bytes;
}
/// Copies the bytes of to_saved() to `numbers`. Returns false if their number differs.
inline bool from_saved(std::span<const std::uint8_t> bytes, std::vector<Real>& numbers) {
  if (bytes.size() != numbers.size() * sizeof(Real)) return false;
  std::memcpy(numbers.data(), bytes.data(), bytes.size());
  return true;
}

/// Pendulum in the plane y = 0 with a rod without mass. The bob does not rotate. Its own steps are
/// those of Runge-Kutta 4.
class PendulumBody final : public ExternalBody {
 public:
  struct Settings {
    Vec3 pivot = Vec3::Zero();  ///< [m]
    Real length = 1;            ///< [m]
    Real gravity = 9.81;        ///< [m/s^2]
    Real angle = 1;             ///< at the start, at rest [rad]
    Real step = 1e-3;           ///< longest own step [s]
  };
  explicit PendulumBody(const Settings& settings) : settings_(settings), angle_(settings.angle) {}

  void start(Real /*time*/, const BodyView& body, BodyMotion& motion) override {
    for (const Real mass : body.masses) mass_ += mass;
    write(motion);
  }

  void advance(const CouplingInterval& interval, const ReceivedImpulses& impulses,
               BodyMotion& motion) override {
    received += impulses.linear;
    push(impulses.linear / 2);
    const auto count = static_cast<int>(std::ceil(interval.length() / settings_.step));
    for (int n = 0; n < count; ++n) take_step(interval.length() / count);
    push(impulses.linear / 2);
    write(motion);
  }

  std::optional<std::vector<std::uint8_t>> save() const override {
    return to_saved({angle_, rate_, mass_});
  }
  bool restore(std::span<const std::uint8_t> saved) override {
    std::vector<Real> numbers(3);
    if (!from_saved(saved, numbers)) return false;
    angle_ = numbers[0];
    rate_ = numbers[1];
    mass_ = numbers[2];
    return true;
  }

  Real angle() const { return angle_; }
  /// Returns the energy relative to the lowest position [J].
  Real energy() const {
    const Real speed = settings_.length * rate_;
    const Real height = settings_.length * (1 - std::cos(angle_));
    return mass_ * (speed * speed / 2 + settings_.gravity * height);
  }

  Vec3 received = Vec3::Zero();  ///< sum of all impulses [N s]

 private:
  void push(const Vec3& impulse) {
    const Vec3 tangent(std::cos(angle_), 0, std::sin(angle_));
    rate_ += tangent.dot(impulse) / (mass_ * settings_.length);
  }
  Real acceleration(Real angle) const {
    return -settings_.gravity / settings_.length * std::sin(angle);
  }
  void take_step(Real dt) {
    const Real a1 = acceleration(angle_);
    const Real v2 = rate_ + dt / 2 * a1;
    const Real a2 = acceleration(angle_ + dt / 2 * rate_);
    const Real v3 = rate_ + dt / 2 * a2;
    const Real a3 = acceleration(angle_ + dt / 2 * v2);
    const Real v4 = rate_ + dt * a3;
    const Real a4 = acceleration(angle_ + dt * v3);
    angle_ += dt / 6 * (rate_ + 2 * v2 + 2 * v3 + v4);
    rate_ += dt / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }
  void write(BodyMotion& motion) const {
    RigidPose& pose = *motion.pose;
    pose.center_of_mass =
        settings_.pivot + settings_.length * Vec3(std::sin(angle_), 0, -std::cos(angle_));
    pose.velocity = settings_.length * rate_ * Vec3(std::cos(angle_), 0, std::sin(angle_));
    pose.angular_velocity.setZero();
  }

  Settings settings_;
  Real angle_ = 0;
  Real rate_ = 0;
  Real mass_ = 0;
};

/// Chain of equal masses along x, joined by equal springs without damping. It moves along x only,
/// and is solved exactly by its modes. The rest lengths are the distances at the start.
class ChainBody final : public ExternalBody {
 public:
  explicit ChainBody(Real stiffness) : stiffness_(stiffness) {}

  void start(Real /*time*/, const BodyView& body, BodyMotion& /*motion*/) override {
    const auto n = static_cast<Eigen::Index>(body.positions.size());
    mass_ = body.masses[0];
    rest_.resize(n);
    velocity_.resize(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      rest_[i] = body.positions[static_cast<std::size_t>(i)].x();
      velocity_[i] = body.velocities[static_cast<std::size_t>(i)].x();
    }
    shift_ = Eigen::VectorXd::Zero(n);
    solver_.compute(stiffness_matrix(n, stiffness_) / mass_);
  }

  void advance(const CouplingInterval& interval, const ReceivedImpulses& impulses,
               BodyMotion& motion) override {
    received += impulses.linear;
    push(impulses.particles);
    move(interval.length());
    push(impulses.particles);
    for (Eigen::Index i = 0; i < rest_.size(); ++i) {
      const auto particle = static_cast<std::size_t>(i);
      motion.positions[particle] = Vec3(rest_[i] + shift_[i], 0, 0);
      motion.velocities[particle] = Vec3(velocity_[i], 0, 0);
    }
  }

  static Eigen::MatrixXd stiffness_matrix(Eigen::Index n, Real stiffness) {
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
    for (Eigen::Index i = 0; i + 1 < n; ++i) {
      matrix(i, i) += stiffness;
      matrix(i + 1, i + 1) += stiffness;
      matrix(i, i + 1) -= stiffness;
      matrix(i + 1, i) -= stiffness;
    }
    return matrix;
  }

  Vec3 received = Vec3::Zero();  ///< sum of all impulses [N s]

 private:
  void push(std::span<const Vec3> impulses) {
    for (Eigen::Index i = 0; i < velocity_.size(); ++i) {
      velocity_[i] += impulses[static_cast<std::size_t>(i)].x() / (2 * mass_);
    }
  }
  void move(Real dt) {
    const Eigen::MatrixXd& modes = solver_.eigenvectors();
    Eigen::VectorXd places = modes.transpose() * shift_;
    Eigen::VectorXd speeds = modes.transpose() * velocity_;
    for (Eigen::Index m = 0; m < places.size(); ++m) {
      // The first mode is the translation.
      const Real omega = m == 0 ? 0 : std::sqrt(solver_.eigenvalues()[m]);
      const Real place = places[m];
      const Real speed = speeds[m];
      if (omega == 0) {
        places[m] = place + dt * speed;
        continue;
      }
      places[m] = place * std::cos(omega * dt) + speed / omega * std::sin(omega * dt);
      speeds[m] = speed * std::cos(omega * dt) - place * omega * std::sin(omega * dt);
    }
    shift_ = modes * places;
    velocity_ = modes * speeds;
  }

  Real stiffness_;
  Real mass_ = 0;
  Eigen::VectorXd rest_;
  Eigen::VectorXd shift_;
  Eigen::VectorXd velocity_;
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver_;
};

/// Rigid body that a motor rotates about the y axis with a constant rate, independent of all
/// forces.
class MotorBody final : public ExternalBody {
 public:
  explicit MotorBody(Real rate) : rate_(rate) {}

  void start(Real time, const BodyView& body, BodyMotion& motion) override {
    start_ = time;
    center_ = body.pose->center_of_mass;
    orientation_ = body.pose->orientation;
    write(time, motion);
  }
  void advance(const CouplingInterval& interval, const ReceivedImpulses& impulses,
               BodyMotion& motion) override {
    received += impulses.linear;
    work += rate_ * -impulses.angular.y();
    write(interval.end, motion);
  }

  Vec3 received = Vec3::Zero();  ///< sum of all impulses [N s]
  Real work = 0;                 ///< of the motor [J]

 private:
  void write(Real time, BodyMotion& motion) const {
    const Eigen::AngleAxisd turn(rate_ * (time - start_), Vec3::UnitY());
    *motion.pose = {center_, Quat(turn) * orientation_, Vec3::Zero(), rate_ * Vec3::UnitY()};
  }

  Real rate_;
  Real start_ = 0;
  Vec3 center_ = Vec3::Zero();
  Quat orientation_ = Quat::Identity();
};

}  // namespace vat::test
