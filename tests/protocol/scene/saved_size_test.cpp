#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <string>

#include "core/saved/greatest_size.h"
#include "core/simulation/simulation.h"
#include "protocol/scene/scene_json.h"
#include "tests/support/saved_bits.h"

// The size of a saved simulation, and its bound that is known before reading.

namespace vat::saved_size_test {
namespace {

struct Size {
  std::size_t particles = 0;
  std::size_t springs = 0;
  std::size_t bytes = 0;
  std::size_t greatest() const { return greatest_saved_size(particles, springs); }
};

/// Returns the size of a body with a refined lattice after some ticks.
Size size_of(Scene scene, double refinement) {
  for (BodyDescription& body : scene.bodies) body.spacing /= refinement;
  Simulation simulation = Simulation::create(scene).value();
  simulation.advance(3 * simulation.steps_per_tick());
  return {simulation.greatest_particle_count(), simulation.spring_count(),
          simulation.snapshot().to_bytes().size()};
}

Result<Scene> scene_of(const std::string& kind, const std::string& solver) {
  const std::string integrator =
      solver == "incompressible" ? "symplectic_euler" : "velocity_verlet";
  const std::string text =
      R"({
    "format": "vat.scene/1", "name": "n", "title": "T", "description": "D",
    "materials": [{"name": "m", "density": 1000,
      "liquid": {"stiffness": 50, "viscosity": 1, "support_radius": 0.3},
      "springs": {"structural": {"stiffness": 50, "damping": 1}}, "tearing_strain": 0.9}],
    "default_interface": {"stiffness": 1000, "damping": 1},
    "vat": {"min": [0, 0, 0], "max": [1, 1, 1], "lid": true},
    "pressure_solver": ")" +
      solver + R"(", "numerics": {"integrator": ")" + integrator +
      R"(", "step": 0.0005, "tick": 0.001},
    "bodies": [{"name": "b", "kind": ")" +
      kind + R"(", "material": "m", "spacing": 0.1,
      "shape": {"type": "box", "center": [0.5, 0.5, 0.4], "size": [0.8, 0.8, 0.6]}}]})";
  return read_scene_text(text, meshes_in_folder("."));
}

class SavedSize : public testing::TestWithParam<std::pair<const char*, const char*>> {};

/// The bound per particle and spring exceeds the actual size, but not by a multiple.
TEST_P(SavedSize, GrowsByAtMostTheGivenSize) {
  const Result<Scene> scene = scene_of(GetParam().first, GetParam().second);
  ASSERT_TRUE(scene.ok()) << scene.errors().front().path << scene.errors().front().message;
  const Size coarse = size_of(scene.value(), 1);
  const Size fine = size_of(scene.value(), 2);
  ASSERT_GT(fine.particles, 6 * coarse.particles);
  const std::size_t grown = fine.bytes - coarse.bytes;
  EXPECT_LE(grown, fine.greatest() - coarse.greatest());
  EXPECT_GE(20 * grown, fine.greatest() - coarse.greatest());
}

INSTANTIATE_TEST_SUITE_P(Kinds, SavedSize,
                         testing::Values(std::pair("liquid", "tait"),
                                         std::pair("liquid", "incompressible"),
                                         std::pair("deformable", "tait")));

// Each catalogue scene, saved at its start and later, continues with the same bits after it is
// read.
TEST(SavedCatalogue, ContinuesFromItsBytes) {
  for (const auto& file : std::filesystem::directory_iterator(VAT_SOURCE_DIR "/protocol/scenes")) {
    if (file.path().extension() != ".json") continue;
    SCOPED_TRACE(file.path().stem().string());
    const Result<Scene> scene = read_scene_file(file.path().string());
    ASSERT_TRUE(scene.ok());
    Simulation simulation = test::make_simulation(scene.value());
    test::expect_goes_on(simulation, 3);
    simulation.advance(7 * simulation.steps_per_tick() + 1);
    test::expect_goes_on(simulation, 3);
    EXPECT_LE(simulation.snapshot().to_bytes().size(),
              greatest_saved_size(simulation.greatest_particle_count(), simulation.spring_count()));
  }
}

}  // namespace
}  // namespace vat::saved_size_test
