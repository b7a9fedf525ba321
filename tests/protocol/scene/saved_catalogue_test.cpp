#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "core/saved/greatest_size.h"
#include "protocol/scene/scene_json.h"
#include "tests/support/saved_bits.h"

// Each catalogue scene, saved at its start and later, continues with the same bits after it is
// read.

namespace vat::saved_catalogue_test {
namespace {

using namespace test;

TEST(SavedCatalogue, ContinuesFromItsBytes) {
  for (const auto& file : std::filesystem::directory_iterator(VAT_SOURCE_DIR "/protocol/scenes")) {
    if (file.path().extension() != ".json") continue;
    SCOPED_TRACE(file.path().stem().string());
    const Result<Scene> scene = read_scene_file(file.path().string());
    ASSERT_TRUE(scene.ok());
    Simulation simulation = make_simulation(scene.value());
    expect_goes_on(simulation, 3);
    simulation.advance(7 * simulation.steps_per_tick() + 1);
    expect_goes_on(simulation, 3);
    EXPECT_LE(simulation.snapshot().to_bytes().size(),
              greatest_saved_size(simulation.greatest_particle_count(), simulation.spring_count()));
  }
}

}  // namespace
}  // namespace vat::saved_catalogue_test
