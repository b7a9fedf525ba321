#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "protocol/scene/level.h"
#include "protocol/scene/scene_json.h"
#include "tests/validation/cases.h"

namespace vat::validation {

namespace {

// LIQ-21. Waves of a piston, compared with linear theory (R. G. Dean and R. A. Dalrymple, Water
// Wave Mechanics for Engineers and Scientists, 1991, sections 3 and 6).

constexpr Real kPistonDepth = 0.48;  // [m]
constexpr Real kFirstPlace = 1;      // the evanescent waves of the piston end after two depths [m]
constexpr Real kPlaceDistance = 0.04;
constexpr Real kColumnReach = 0.1;  // half width of the weight of a column [m]

/// Returns the wave number k of omega^2 = g k tanh(k h) [rad/m].
Real piston_wave_number(Real omega) {
  const Real x = omega * omega * kPistonDepth / kGravity;
  Real kh = std::max(x, std::sqrt(x));
  for (int round = 0; round < 50; ++round) {
    const Real tanh = std::tanh(kh);
    kh -= (kh * tanh - x) / (tanh + kh * (1 - tanh * tanh));
  }
  return kh / kPistonDepth;
}

/// Returns wave height / stroke of a piston.
Real piston_height_per_stroke(Real k) {
  const Real kh2 = 2 * k * kPistonDepth;
  return 2 * (std::cosh(kh2) - 1) / (std::sinh(kh2) + kh2);
}

/// Fourier components of the surface at equidistant places, at the frequency of the piston.
class PistonWaves {
 public:
  PistonWaves(Real last, Real omega) : omega_(omega) {
    for (Real x = kFirstPlace; x <= last + kPlaceDistance / 2; x += kPlaceDistance)
      places_.push_back({x, 0, 0});
  }

  /// Adds the heights at one time. The height of a column is its liquid per width.
  void sample(const Simulation& simulation, Real spacing) {
    std::vector<Real> heights(places_.size());
    for (const BodyView& body : simulation.bodies()) {
      if (body.kind != BodyKind::liquid) continue;
      for (const Vec3& x : body.positions) add(x.x(), spacing, heights);
    }
    const Real phase = omega_ * simulation.time();
    for (std::size_t n = 0; n < heights.size(); ++n) {
      places_[n].cosine += heights[n] * std::cos(phase);
      places_[n].sine += heights[n] * std::sin(phase);
    }
    ++samples_;
  }

  /// Returns the mean of the wave heights [m].
  Real height() const {
    Real sum = 0;
    for (const Place& place : places_) sum += std::hypot(place.cosine, place.sine);
    return 4 * sum / (static_cast<Real>(samples_) * static_cast<Real>(places_.size()));
  }

  /// Returns the wave length from the slope of the phase [m].
  Real length() const {
    Real last = 0;
    Real turned = 0;
    Real x_mean = 0;
    std::vector<Real> phases;
    for (const Place& place : places_) {
      const Real phase = std::atan2(place.sine, place.cosine);
      if (!phases.empty()) turned += std::remainder(phase - last, 2 * std::numbers::pi);
      last = phase;
      phases.push_back(turned);
      x_mean += place.x / static_cast<Real>(places_.size());
    }
    Real along = 0;
    Real square = 0;
    for (std::size_t n = 0; n < phases.size(); ++n) {
      along += phases[n] * (places_[n].x - x_mean);
      square += (places_[n].x - x_mean) * (places_[n].x - x_mean);
    }
    return 2 * std::numbers::pi * square / along;
  }

 private:
  struct Place {
    Real x = 0;
    Real cosine = 0;
    Real sine = 0;
  };

  void add(Real x, Real spacing, std::vector<Real>& heights) const {
    const int nearest = static_cast<int>(std::lround((x - kFirstPlace) / kPlaceDistance));
    const int width = static_cast<int>(kColumnReach / kPlaceDistance) + 1;
    for (int n = nearest - width; n <= nearest + width; ++n) {
      if (n < 0 || n >= static_cast<int>(places_.size())) continue;
      const Real share = 1 - std::abs(x - places_[static_cast<std::size_t>(n)].x) / kColumnReach;
      if (share > 0)
        heights[static_cast<std::size_t>(n)] += share / kColumnReach * spacing * spacing;
    }
  }

  Real omega_;
  std::vector<Place> places_;
  int samples_ = 0;
};

/// The tank of the catalogue at the level fine, without its boats, which displace water at the
/// places of the samples. At the level normal, the error of the height is near the tolerance:
/// from 4.4 to 5.9 % for starts that differ by rounding.
Scene catalogue_tank() {
  const std::string path = VAT_SOURCE_DIR "/protocol/scenes/wave-tank.json";
  Result<Scene> read = read_scene_file(path);
  if (!read) throw std::invalid_argument(path + ": " + read.errors()[0].message);
  Scene scene = at_level(std::move(read).value(), Level::fine).value();
  std::erase_if(scene.bodies, [](const BodyDescription& body) {
    return body.kind == BodyKind::rigid && !body.fixed && !body.motion;
  });
  return scene;
}

/// Measures the waves in two periods of the piston from `start` [s], at places up to `last` [m].
void check_piston_waves(Sheet& sheet, Scene scene, const std::string& of, Real start, Real last) {
  const SlideMotion motion = *body_of(scene, "piston").motion;
  const Real omega = 2 * std::numbers::pi / motion.period;
  const Real k = piston_wave_number(omega);
  PistonWaves surface(last, omega);
  Run run = sheet.start(scene);
  run.advance_to(start + kPlaceDistance);
  // The samples of whole periods, without the first of the two ends.
  run.observe_until(start + 2 * motion.period, kPlaceDistance,
                    [&] { surface.sample(run.simulation(), scene.bodies[0].spacing); });
  const char* const source = "waves of a wave tank: 5 % from linear theory";
  sheet.add("wave height [m], " + of, motion.stroke * piston_height_per_stroke(k), surface.height(),
            within_relative(0.05, source), run);
  sheet.add("wave length [m], " + of, 2 * std::numbers::pi / k, surface.length(),
            within_relative(0.05, source), run);
}

void run_piston(Sheet& sheet) {
  check_piston_waves(sheet, catalogue_tank(), "wave-tank of the catalogue", 4.8, 2.5);
  if (!sheet.quick()) check_piston_waves(sheet, load_scene("LIQ-21"), "straight tank", 4, 3);
}

}  // namespace

std::vector<Case> liquid_piston_cases() {
  return {{"LIQ-21", "waves of a piston", "liquid", {"LIQ-21"}, run_piston}};
}

}  // namespace vat::validation
