#include "protocol/tune/motion.h"

#include <algorithm>
#include <cmath>

#include "core/support/check.h"

namespace vat::tune {
namespace {

constexpr Real kLowShare = 0.05;
constexpr Real kHighShare = 0.95;
constexpr Real kLeastShare = 0.1;  // of the mean particle radius

Real quantile(std::vector<Real>& values, Real share) {
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<Real>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

BodyPlace place_of(const BodyView& body) {
  BodyPlace place{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  Real mass = 0;
  for (std::size_t i = 0; i < body.positions.size(); ++i) {
    place.center += body.masses[i] * body.positions[i];
    mass += body.masses[i];
  }
  place.center /= mass;
  std::vector<Real> values(body.positions.size());
  for (int axis = 0; axis < 3; ++axis) {
    std::ranges::transform(body.positions, values.begin(),
                           [axis](const Vec3& x) { return x[axis]; });
    place.low[axis] = quantile(values, kLowShare);
    place.high[axis] = quantile(values, kHighShare);
  }
  return place;
}

/// Returns the sum of squares of centres and extents. Bodies that only one moment has count with
/// nothing: emitters and drains change them at the same times.
template <class Function>
void for_each_common(const Moment& a, const Moment& b, Function&& function) {
  VAT_CHECK(a.bodies.size() == b.bodies.size());
  for (std::size_t i = 0; i < a.bodies.size(); ++i) {
    if (a.bodies[i] && b.bodies[i]) function(*a.bodies[i], *b.bodies[i]);
  }
}

Real extent_distance2(const BodyPlace& a, const BodyPlace& b) {
  return ((a.low - b.low).squaredNorm() + (a.high - b.high).squaredNorm()) / 2;
}

}  // namespace

std::vector<bool> find_free_bodies(const Scene& scene) {
  std::vector<bool> are_free;
  for (const BodyDescription& body : scene.bodies) {
    are_free.push_back(!body.fixed && !body.motion);
  }
  return are_free;
}

Moment measure(const Simulation& simulation, const std::vector<bool>& free_bodies) {
  Moment moment;
  Real mass = 0;
  Real energy = 0;
  const std::vector<BodyView> bodies = simulation.bodies();
  for (std::size_t b = 0; b < std::min(bodies.size(), free_bodies.size()); ++b) {
    if (!free_bodies[b]) continue;
    const BodyView& body = bodies[b];
    moment.bodies.emplace_back();
    if (body.positions.empty()) continue;
    moment.bodies.back() = place_of(body);
    for (std::size_t i = 0; i < body.velocities.size(); ++i) {
      mass += body.masses[i];
      energy += body.masses[i] * body.velocities[i].squaredNorm();
    }
  }
  moment.speed = mass > 0 ? std::sqrt(energy / mass) : 0;
  return moment;
}

LeastMotion least_motion(const Simulation& simulation, Real duration) {
  Real sum = 0;
  std::size_t count = 0;
  for (const BodyView& body : simulation.bodies()) {
    for (const Real radius : body.radii) sum += radius;
    count += body.radii.size();
  }
  const Real length = count > 0 ? kLeastShare * sum / static_cast<Real>(count) : 1;
  return {length, length / duration};
}

ErrorMeasure::Squares& ErrorMeasure::Squares::operator+=(const Squares& other) {
  center += other.center;
  extent += other.extent;
  speed += other.speed;
  return *this;
}

ErrorMeasure::Squares ErrorMeasure::deviation(const Moment& a, const Moment& b) {
  Squares squares;
  for_each_common(a, b, [&](const BodyPlace& in_a, const BodyPlace& in_b) {
    squares.center += (in_a.center - in_b.center).squaredNorm();
    squares.extent += extent_distance2(in_a, in_b);
  });
  squares.speed = (a.speed - b.speed) * (a.speed - b.speed);
  return squares;
}

ErrorMeasure::Squares ErrorMeasure::motion_from(const Moment& start, const Moment& now) {
  Squares squares = deviation(start, now);
  squares.speed = now.speed * now.speed;
  return squares;
}

Real ErrorMeasure::quotient(const Squares& deviation) const {
  return std::sqrt(std::max({deviation.center / scale_.center, deviation.extent / scale_.extent,
                             deviation.speed / scale_.speed}));
}

ErrorMeasure::ErrorMeasure(Motion fine, const Motion& coarse, const LeastMotion& least)
    : fine_(std::move(fine)), least_(least) {
  VAT_CHECK(fine_.size() == coarse.size() && fine_.size() >= 2);
  const auto bodies = static_cast<Real>(std::max<std::size_t>(1, fine_.front().bodies.size()));
  const Real least_length2 = bodies * least.length * least.length;
  // The horizon: the last moment up to which the noise is small, at least the first moment.
  Squares sum;
  Squares motion;
  for (std::size_t k = 1; k < fine_.size(); ++k) {
    sum += deviation(fine_[k], coarse[k]);
    motion += motion_from(fine_.front(), fine_[k]);
    motion += Squares{least_length2, least_length2, least.speed * least.speed};
    const Squares before = scale_;
    scale_ = motion;
    if (k > 1 && quotient(sum) > kMaxNoise) {
      scale_ = before;
      break;
    }
    horizon_ = k;
  }
  floor_ = std::max(bound(coarse), kLeastError);
}

Real ErrorMeasure::bound(std::span<const Moment> run) const {
  Squares sum;
  for (std::size_t k = 1; k < std::min(run.size(), horizon_ + 1); ++k) {
    sum += deviation(run[k], fine_[k]);
  }
  return quotient(sum);
}

}  // namespace vat::tune
