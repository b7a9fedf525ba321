#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/scene/scene.h"
#include "core/simulation/simulation.h"

namespace vat::tune {

/// Position and extent of one body.
struct BodyPlace {
  Vec3 center;  ///< centre of mass [m]
  Vec3 low;     ///< quantiles of 5 % of the particle positions, by axis [m]
  Vec3 high;    ///< quantiles of 95 % [m]
};

/// State of the scene at one moment, as far as candidates are compared.
struct Moment {
  /// One for each free body, in the order of the scene. Bodies without particles are empty.
  std::vector<std::optional<BodyPlace>> bodies;
  Real speed = 0;  ///< root mean square of the particle velocities, weighted by mass [m/s]
};

/// Returns for each body whether forces move it. Fixed and driven bodies move equally in all runs.
std::vector<bool> find_free_bodies(const Scene& scene);

/// Returns the current state. Only bodies of the scene are measured.
Moment measure(const Simulation& simulation, const std::vector<bool>& free_bodies);

/// Moments of one run, beginning with time 0.
using Motion = std::vector<Moment>;

/// Length and speed below which differences do not count as motion.
struct LeastMotion {
  Real length = 0;  ///< [m]
  Real speed = 0;   ///< [m/s]
};
/// Returns a tenth of the mean particle radius, and the speed of this distance in `duration` [s].
LeastMotion least_motion(const Simulation& simulation, Real duration);

/// Error of runs relative to a reference run. Deviations from the reference, squared, are summed
/// over the moments and divided by the squared motion of the reference. The error is the square
/// root of the greatest of three quotients:
///
/// - centres of mass, relative to their displacement from the start;
/// - quantiles of 5 % and 95 % of the positions, which contain fronts, relative to theirs;
/// - root mean square speed, which contains the kinetic energy.
///
/// The distance between both references is the noise: of the method, and of chaotic motion. Moments
/// after the first one with a noise above kMaxNoise are not compared, except the first moment.
class ErrorMeasure {
 public:
  /// Both motions must have the same number of moments, at least two.
  ErrorMeasure(Motion fine, const Motion& coarse, const LeastMotion& least);

  static constexpr Real kMaxNoise = 0.1;
  /// Rounding errors grow to this error. Smaller errors are not compared.
  static constexpr Real kLeastError = 1e-9;

  /// Returns the number of compared moments after the start.
  std::size_t horizon() const { return horizon_; }
  /// Returns a lower bound of the error of a run, of which `run` contains the first moments. The
  /// bound increases with each moment, up to the error itself.
  Real bound(std::span<const Moment> run) const;
  /// Returns the noise: bound() of the coarse reference, at least kLeastError. Errors below it
  /// count as this value.
  Real floor() const { return floor_; }

 private:
  /// Squares of deviations or of motion, by quantity.
  struct Squares {
    Real center = 0;
    Real extent = 0;
    Real speed = 0;
    Squares& operator+=(const Squares& other);
  };
  static Squares deviation(const Moment& a, const Moment& b);
  static Squares motion_from(const Moment& start, const Moment& now);
  Real quotient(const Squares& deviation) const;

  Motion fine_;
  LeastMotion least_;
  std::size_t horizon_ = 0;
  Squares scale_;
  Real floor_ = 0;
};

}  // namespace vat::tune
