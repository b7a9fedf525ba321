#include "tests/stability/closed_pairs.h"

#include <algorithm>

#include "tests/stability/builders.h"
#include "tests/support/totals.h"

namespace vat::stability {
namespace {

/// Returns the surface points of a cubic lattice of n^3 points.
std::vector<Vec3> make_shell(int n) {
  const Real half = (n - 1) / 2.0 * kSpacing;
  std::vector<Vec3> shell = test::make_lattice(n, n, n, kSpacing);
  std::erase_if(shell,
                [&](const Vec3& p) { return p.cwiseAbs().maxCoeff() < half - kSpacing / 2; });
  return shell;
}

}  // namespace

Scene make_closed_pair(BodyKind first, BodyKind second) {
  Scene scene = make_scene();
  scene.name = std::string(to_string(first)) + " and " + to_string(second);
  scene.gravity = Vec3::Zero();
  scene.interfaces.clear();
  scene.default_interface = {2000, 0};
  for (Material& material : scene.materials) {
    if (material.liquid) material.liquid->viscosity = 0;
  }
  scene.bodies = {make_block("first", first, 3, {-0.08, 0, 0.01}),
                  make_block("second", second, 3, {0.09, 0.02, 0}),
                  test::make_body("cage", BodyKind::rigid, "wood",
                                  test::make_particles(make_shell(9), 0.125), kSpacing / 2)};
  if (second == BodyKind::liquid) scene.bodies[1].material = "oil";
  scene.bodies[0].velocity = {0.5, 0.1, 0};
  scene.bodies[1].velocity = {-0.4, 0.1, 0.2};
  scene.bodies[2].angular_velocity = {0.3, -0.2, 0.4};
  return scene;
}

std::vector<Scene> closed_pairs() {
  std::vector<Scene> scenes;
  for (std::size_t a = 0; a < std::size(kKinds); ++a) {
    for (std::size_t b = a; b < std::size(kKinds); ++b) {
      scenes.push_back(make_closed_pair(kKinds[b], kKinds[a]));
    }
  }
  return scenes;
}

ClosedRun run_closed(const Scene& scene, std::uint32_t steps) {
  constexpr std::uint32_t kAtOnce = 20;
  Simulation simulation = test::make_simulation(scene);
  const Diagnostics start = simulation.diagnostics();
  const test::Totals before = test::totals_of(start);
  const auto [motion, turning] = test::motion_of(simulation);
  ClosedRun result;
  result.name = scene.name;
  const auto grow = [](Real& most, Real value) { most = std::max(most, value); };
  for (std::uint32_t n = 0; n < steps; n += kAtOnce) {
    result.undone += simulation.advance(kAtOnce).undone_steps;
    const Diagnostics now = simulation.diagnostics();
    const test::Totals after = test::totals_of(now);
    grow(result.momentum, (after.momentum - before.momentum).norm() / motion);
    grow(result.angular_momentum,
         (after.angular_momentum - before.angular_momentum).norm() / turning);
    grow(result.contact_energy, now.contact_energy);
    for (std::size_t b = 0; b < now.bodies.size(); ++b) {
      const Vec3 change = now.bodies[b].linear_momentum - start.bodies[b].linear_momentum;
      grow(result.exchanged, change.norm() / motion);
    }
  }
  result.hash = simulation.state_hash();
  return result;
}

}  // namespace vat::stability
