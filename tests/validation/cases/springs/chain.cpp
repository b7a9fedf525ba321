#include <cmath>
#include <numbers>

#include "tests/validation/cases.h"
#include "tests/validation/order.h"
#include "tests/validation/reference.h"

namespace vat::validation {

namespace {

constexpr int kMasses = 16;
constexpr Real kChainStep = 1e-3;

Real mode_shape(int mode, int node) {
  return std::sin(mode * std::numbers::pi * node / (kMasses + 1));
}

/// Displaces the nodes from the x axis in one mode.
Scene chain_in_mode(int mode, int axis, Real amplitude) {
  Scene scene = with_step(load_scene("DEF-2"), kChainStep);
  std::vector<Vec3>& positions = std::get<ParticleShape>(scene.bodies[0].shape).positions;
  for (int i = 0; i < kMasses + 2; ++i) {
    const auto node = static_cast<std::size_t>(i);
    positions[node] = Vec3(reference("/deformable/DEF-2/a") * i, 0, 0);
    positions[node][axis] += amplitude * mode_shape(mode, i);
  }
  return scene;
}

/// Returns the amplitude of the mode in the present state. A constant part would falsify the fit.
Real mode_amplitude(const BodyView& chain, int mode, int axis) {
  Real sum = 0;
  for (int i = 1; i <= kMasses; ++i) {
    const Real rest = axis == 0 ? reference("/deformable/DEF-2/a") * i : 0;
    sum += (chain.positions[static_cast<std::size_t>(i)][axis] - rest) * mode_shape(mode, i);
  }
  return sum;
}

void add_mode(Sheet& sheet, const std::string& direction, int mode, int axis, Real amplitude) {
  const std::string number = std::to_string(mode);
  const Real omega = reference("/deformable/DEF-2/omega_" + direction + '/' + number);
  const int periods = sheet.quick() ? 5 : 20;
  const Real end = std::round(periods * 2 * std::numbers::pi / omega / kChainStep) * kChainStep;
  Run run = sheet.start(chain_in_mode(mode, axis, amplitude));
  std::vector<Real> samples;
  run.observe_until(end, kChainStep,
                    [&] { samples.push_back(mode_amplitude(run.body(), mode, axis)); });
  const Real z2 = std::pow(omega * kChainStep, 2);
  sheet.add("frequency of " + direction + ". mode " + number + " [rad/s]", omega,
            fitted_frequency(samples, kChainStep),
            within_relative(z2 / 24 + z2 * z2 / 100 + 1e-6, "z^2/24 of Verlet, fit 1e-6"), run);
}

void run_modes(Sheet& sheet) {
  const Real spacing = reference("/deformable/DEF-2/a");
  for (const int mode : {1, 2, 4, 8, 16}) add_mode(sheet, "long", mode, 0, 1e-3 * spacing);
  for (const int mode : {1, 2, 4, 8, 16}) add_mode(sheet, "trans", mode, 1, 1e-5 * spacing);
}

}  // namespace

std::vector<Case> chain_cases() {
  return {{"DEF-2", "modes of a stretched chain", "deformable", {"DEF-2"}, run_modes}};
}

}  // namespace vat::validation
