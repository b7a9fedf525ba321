#include "tests/stability/growth_sweep.h"

#include <chrono>

#include "core/simulation/simulation.h"
#include "core/support/check.h"
#include "tests/support/scenes.h"

namespace vat::stability {
namespace {

Scene make_falling(Real step) {
  Scene scene = test::make_scene(IntegratorId::velocity_verlet, step);
  scene.gravity = {0, 0, -9.81};
  return scene;
}

Scene make_masonry() {
  Scene scene = make_falling(5e-3);
  scene.vat = Vat{{-2, -2, 0}, {2, 2, 12}, false, {}, {}};
  scene.materials = {test::make_material("brick", 1800)};
  scene.default_interface.law = InterfaceLaw::projection;
  scene.default_interface.friction = 0.6;
  return scene;
}

void add_block(Scene& scene, const Vec3& center, const Vec3& size, Real spacing) {
  BodyDescription block;
  block.name = "block " + std::to_string(scene.bodies.size());
  block.kind = BodyKind::rigid;
  block.material = "brick";
  block.spacing = spacing;
  block.shape = BoxShape{Vec3::Zero(), size};
  block.position = center;
  scene.bodies.push_back(block);
}

/// A stack of `height` blocks of eight particles at rest on the floor.
Scene make_stack(int height) {
  constexpr Real kSize = 0.2;
  Scene scene = make_masonry();
  for (int n = 0; n < height; ++n) {
    add_block(scene, {0, 0, kSize * (n + 0.5)}, {kSize, kSize, kSize}, kSize / 2);
  }
  return scene;
}

/// A wall of `height` rows of four bricks at rest on the floor. Each row is displaced by a quarter
/// of a brick relative to the row below it.
Scene make_wall(int height) {
  const Vec3 size(0.2, 0.1, 0.1);
  Scene scene = make_masonry();
  for (int row = 0; row < height; ++row) {
    for (int n = 0; n < 4; ++n) {
      const Real along = (n + 0.25 * (row % 2)) * size.x();
      add_block(scene, {along, 0, (row + 0.5) * size.z()}, size, 0.05);
    }
  }
  return scene;
}

/// A pool of honey whose viscosity is `factor` times 1 Pa s.
Scene make_viscous_pool(int factor) {
  constexpr Real kSpacing = 0.05;
  Scene scene = make_falling(2e-3);
  scene.vat = Vat{{0, 0, 0}, {0.8, 0.4, 0.8}, true, {}, {}};
  scene.materials = {
      test::make_liquid("honey", 1400, {64, static_cast<Real>(factor), 2 * kSpacing})};
  BodyDescription pool;
  pool.name = "pool";
  pool.kind = BodyKind::liquid;
  pool.material = "honey";
  pool.spacing = kSpacing;
  pool.shape = BoxShape{{0.2, 0.2, 0.3}, {0.4, 0.4, 0.6}};
  scene.bodies = {pool};
  return scene;
}

/// A horizontal rope that falls, held at one end.
Scene make_rope(int count, const SpringConstants& constants, Real step) {
  Scene scene = make_falling(step);
  scene.materials = {test::make_material("rope")};
  ParticleShape shape = test::make_particles(test::make_lattice(count, 1, 1, 0.1), 0.1);
  shape.fixed = {0};
  scene.bodies = {test::make_body("rope", BodyKind::deformable, "rope", shape, 0.02)};
  scene.bodies[0].springs = test::join_near(shape.positions, 0.11, constants);
  return scene;
}

Scene make_implicit_rope(int count) {
  Scene scene = make_rope(count, {1e8, 1e3}, 1e-3);
  scene.materials[0].implicit_springs = true;
  return scene;
}

Scene make_limited_rope(int count) {
  Scene scene = make_rope(count, {10, 0.1}, 1e-3);
  scene.materials[0].elongation_limit = 0.01;
  return scene;
}

}  // namespace

const std::vector<GrowthFamily>& growth_families() {
  static const std::vector<GrowthFamily> families = {{"contacts in a stack",
                                                      "blocks",
                                                      {2, 5, 10, 20, 40},
                                                      &make_stack,
                                                      &IterationCounts::contacts},
                                                     {"contacts in a wall",
                                                      "rows of bricks",
                                                      {1, 2, 4, 8, 16},
                                                      &make_wall,
                                                      &IterationCounts::contacts},
                                                     {"damping",
                                                      "viscosity [Pa s]",
                                                      {1, 10, 100, 1000, 10'000},
                                                      &make_viscous_pool,
                                                      &IterationCounts::damping},
                                                     {"implicit springs",
                                                      "particles in a rope",
                                                      {5, 20, 50, 100, 200},
                                                      &make_implicit_rope,
                                                      &IterationCounts::springs},
                                                     {"limited elongation",
                                                      "particles in a rope",
                                                      {5, 20, 50, 100, 200},
                                                      &make_limited_rope,
                                                      &IterationCounts::elongation}};
  return families;
}

GrowthPoint measure_growth(const GrowthFamily& family, int size, Index steps) {
  using Clock = std::chrono::steady_clock;
  VAT_CHECK(steps > 0);
  Simulation simulation = test::make_simulation(family.make(size));
  const std::size_t events_before = simulation.advance(steps).events.size();
  const Clock::time_point start = Clock::now();
  const AdvanceReport report = simulation.advance(steps);
  const std::chrono::duration<double> spent = Clock::now() - start;
  const auto count = static_cast<double>(report.steps);
  GrowthPoint point{.size = size,
                    .iterations = static_cast<double>(report.iterations.*family.iterations) / count,
                    .seconds = spent.count() / count,
                    .events = events_before + report.events.size()};
  for (const BodyView& body : simulation.bodies()) point.particles += body.positions.size();
  return point;
}

}  // namespace vat::stability
