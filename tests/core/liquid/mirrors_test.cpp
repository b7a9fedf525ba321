#include "core/liquid/pairs/mirrors.h"

#include <gtest/gtest.h>

#include "core/liquid/pairs/pair_sources.h"
#include "tests/support/force_probe.h"
#include "tests/support/scenes.h"

namespace vat::test::mirrors_test {
namespace {

constexpr Real kSpacing = 0.05;

/// A box filled with liquid at rest density.
Scene make_full_box(int dimensions, Real ratio) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 1e-3);
  scene.dimensions = dimensions;
  scene.pressure_solver = PressureSolver::tait;
  scene.pair_precision = PairPrecision::double_precision;
  scene.materials = {make_liquid("water", 1000, {100, 0, ratio * kSpacing})};
  const int n = 6;
  const int depth = dimensions == 3 ? n : 1;
  const Real half = n * kSpacing / 2;
  scene.vat = Vat{Vec3::Constant(-half), Vec3::Constant(half), true, {}};
  scene.bodies = {make_body(
      "water", BodyKind::liquid, "water",
      make_particles(make_lattice(n, depth, n, kSpacing), 1000 * std::pow(kSpacing, dimensions)),
      kSpacing / 2)};
  return scene;
}

TEST(Mirrors, CompleteALatticeAtFacesEdgesAndCorners) {
  for (const int dimensions : {2, 3}) {
    for (const Real ratio : {2.0, 3.0}) {
      const ForceProbe probe(make_full_box(dimensions, ratio));
      for (const Real density : probe.work().of<LiquidScratch>().density) {
        EXPECT_NEAR(density, 1000, 1e-9) << dimensions << ' ' << ratio;
      }
    }
  }
}

// Covers every combination of walls and periodic axes that mirrors a particle.
TEST(Mirrors, AreTheSameImagesOncePacked) {
  Scene scene = make_full_box(3, 2);
  scene.periodic = Periodicity{{-0.15, 0, 0}, {0.15, 0, 0}, {true, false, false}};
  const ForceProbe probe(scene);
  const VatMotion motion{{0, 0.1, -0.2}, {2, 0, 0}, {}};
  const ImageOffsets offsets(probe.model(), motion);
  const PeriodicBox& box = probe.model().periodic;
  int count = 0;
  for_each_mirror(probe.model(), motion, Vec3::Zero(), 1, [&](const Mirror& mirror) {
    box.for_each_image(mirror.place(Vec3::Zero()), 1, [&](const Vec3& shift) {
      const PairImage image{mirror.twice_plane + shift, 7, mirror.axes};
      const PairImage unpacked = offsets.unpack(offsets.pack(image));
      EXPECT_EQ(unpacked.offset, image.offset);
      EXPECT_EQ(unpacked.axes, image.axes);
      EXPECT_EQ(unpacked.source, 7U);
      ++count;
    });
  });
  EXPECT_EQ(count, 3 * (2 + 2 + 4));  // images in the box, at faces and at edges
}

TEST(Mirrors, ReflectPlacesAtMovingWalls) {
  Scene scene = make_full_box(3, 2);
  const ForceProbe probe(scene);
  const VatMotion motion{{0.1, 0, 0}, {2, 0, 0}, {}};
  const Real half = 3 * kSpacing;
  int count = 0;
  for_each_mirror(probe.model(), motion, {0.1 - half + 0.01, 0, 0.02 - half}, 0.1,
                  [&](const Mirror& mirror) {
                    ++count;
                    const Vec3 place = mirror.place({0.1 - half + 0.01, 0, 0.02 - half});
                    EXPECT_EQ(place.y(), 0);
                    EXPECT_NEAR(place.x() - (0.1 - half), mirror.axes[0] ? -0.01 : 0.01, 1e-15);
                    EXPECT_NEAR(place.z() + half, mirror.axes[2] ? -0.02 : 0.02, 1e-15);
                  });
  EXPECT_EQ(count, 3);  // two faces and their common edge
}

}  // namespace
}  // namespace vat::test::mirrors_test
