#include <cmath>
#include <numbers>

#include "tests/validation/cases.h"
#include "tests/validation/cases/liquid/liquid_rest.h"
#include "tests/validation/cases/liquid/liquid_wave.h"

// A light liquid on a heavy one.

namespace vat::validation {

namespace {

constexpr Real kWaveNumber = std::numbers::pi;  // half a wave in the tank [1/m]
constexpr std::size_t kAbove = 0;               // index in the scene's materials and bodies
constexpr std::size_t kBelow = 1;
constexpr Real kLayersWave = 0.05;  // amplitude of the interface [m]

/// Linear waves of two inviscid liquids, the upper one with a free surface (H. Lamb, Hydrodynamics,
/// 6th ed., Cambridge, 1932, art. 231).
struct TwoLayers {
  Real density_below = 0;  ///< [kg/m^3]
  Real density_above = 0;
  Real depth_below = 0;  ///< [m]
  Real depth_above = 0;

  /// Returns the fraction of gravity that acts at the interface of deep layers.
  Real share_of_gravity() const {
    return (density_below - density_above) / (density_below + density_above);
  }

  /// Returns omega^2 of the slower of the two modes of the wave number, which is that of the
  /// interface.
  Real omega2() const {
    const Real coth_below = 1 / std::tanh(kWaveNumber * depth_below);
    const Real coth_above = 1 / std::tanh(kWaveNumber * depth_above);
    const Real gk = kGravity * kWaveNumber;
    const Real a = density_below * coth_below * coth_above + density_above;
    const Real b = density_below * gk * (coth_below + coth_above);
    const Real c = (density_below - density_above) * gk * gk;
    return (b - std::sqrt(b * b - 4 * a * c)) / (2 * a);
  }

  /// Returns the displacement at x by that mode, with its crest at the left wall and z measured
  /// from the floor.
  Vec3 displacement(const Vec3& x) const {
    const Real k = kWaveNumber;
    const Real below = kLayersWave / std::sinh(k * depth_below);
    if (x.z() < depth_below) {
      return below * Vec3(-std::cosh(k * x.z()) * std::sin(k * x.x()), 0,
                          std::sinh(k * x.z()) * std::cos(k * x.x()));
    }
    // The pressure is equal on both sides of the interface.
    const Real push = density_below * below * std::cosh(k * depth_below) -
                      (density_below - density_above) * kGravity * k * kLayersWave / omega2();
    const Real even = push / density_above;
    const Real z = k * (x.z() - depth_below);
    const Real along = even * std::cosh(z) + kLayersWave * std::sinh(z);
    const Real across = even * std::sinh(z) + kLayersWave * std::cosh(z);
    return {-along * std::sin(k * x.x()), 0, across * std::cos(k * x.x())};
  }
};

/// Returns a body of one of the layers, compressed by the weight at rest, with the velocities of
/// the wave as it passes through zero. Only a small displacement would conserve volumes.
ParticleShape wave_of(const Scene& scene, const TwoLayers& layers, std::size_t body) {
  const Real c2_above = scene.materials[kAbove].liquid->stiffness;
  const Real c2_below = scene.materials[kBelow].liquid->stiffness;
  const Real load = layers.depth_above * layers.density_above / layers.density_below;
  const Real interface = pressed_height(layers.depth_below, load, c2_below);
  const Real surface = interface + pressed_height(layers.depth_above, 0, c2_above);
  const Run run(scene);
  ParticleShape shape;
  const BodyView layer = run.simulation().bodies()[body];
  for (Vec3 x : layer.positions) {
    shape.velocities.push_back(std::sqrt(layers.omega2()) * layers.displacement(x));
    const Real below_interface = layers.depth_below - x.z();
    x.z() = below_interface > 0
                ? interface - pressed_height(below_interface, load, c2_below)
                : surface - pressed_height(layers.depth_above + below_interface, 0, c2_above);
    shape.positions.push_back(x);
  }
  return shape;
}

TwoLayers layers_of(const Scene& scene) {
  const auto depth = [&](std::size_t body) {
    return std::get<BoxShape>(scene.bodies[body].shape).size.z();
  };
  return {scene.materials[kBelow].density, scene.materials[kAbove].density, depth(kBelow),
          depth(kAbove)};
}

/// A scene in which each layer has `count` layers of particles.
Scene interfacial_wave(int count, Real density_ratio) {
  Scene scene = load_scene("LIQ-18");
  Material& light = scene.materials[kAbove];
  const Material& heavy = scene.materials[kBelow];
  light.density = density_ratio * heavy.density;
  light.liquid->stiffness = heavy.liquid->stiffness / density_ratio;  // the same bulk modulus
  const TwoLayers layers = layers_of(scene);
  for (std::size_t i = 0; i < 2; ++i) {
    scene.bodies[i].spacing = layers.depth_below / count;
    scene.materials[i].liquid->support_radius = 3 * scene.bodies[i].spacing;
  }
  const ParticleShape below = wave_of(scene, layers, kBelow);
  const ParticleShape above = wave_of(scene, layers, kAbove);
  scene.bodies[kBelow].shape = below;
  scene.bodies[kAbove].shape = above;
  return with_step(scene, acoustic_step(scene, 0.01));
}

void check_period(Sheet& sheet, int count, const char* density_ratio) {
  const Scene scene = interfacial_wave(count, std::stod(density_ratio));
  TwoLayers layers = layers_of(load_scene("LIQ-18"));
  layers.density_above = scene.materials[kAbove].density;
  const Real period = 2 * std::numbers::pi / std::sqrt(layers.omega2());
  Run run = sheet.start(scene);
  const Swing seen = observe_swing(run, std::round(170 * period) / 100, [&] {
    return run.diagnostics().bodies[kBelow].center_of_mass.x() - 0.5;
  });
  sheet.add("period [s], density ratio " + std::string(density_ratio) + ", 2 x " +
                std::to_string(count) + " layers",
            period, seen.zeros.at(2) - seen.zeros[0],
            within_relative(0.01 / layers.share_of_gravity(),
                            "a hundredth at a surface, over the share of gravity at the interface"),
            run);
}

void run_interfacial_wave(Sheet& sheet) {
  check_period(sheet, 12, "0.5");
  if (sheet.quick()) return;
  for (const char* ratio : {"0.2", "0.5", "0.8"}) check_period(sheet, 24, ratio);
}

}  // namespace

std::vector<Case> two_liquid_cases() {
  return {{"LIQ-18",
           "oscillating interface of two liquids",
           "liquid",
           {"LIQ-18"},
           run_interfacial_wave}};
}

}  // namespace vat::validation
