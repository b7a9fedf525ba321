// What a saved state may be where it is loaded again.

#include "server/session/saved_state.h"

#include <gmock/gmock.h>

#include "server/session/scene_loading.h"
#include "tests/server/packed_size.h"
#include "tests/server/session_fixture.h"
#include "tests/support/lone_environment.h"

namespace vat::test::saved_state_test {
namespace {

using testing::HasSubstr;

class SavedStateEntries : public testing::Test {
 protected:
  SavedStateEntries() : scene_(Simulation::create(to_scene(mixed_scene_text())).value()) {}

  /// Why a state is not restored; a limit by its name.
  std::string fault(const SavedState& state, std::size_t particles_in_all = 1'000'000) {
    ResourceBudget resources({particles_in_all, kUnlimitedResources.springs});
    const SessionEnvironment environment = environment_.with(resources);
    SessionCore core("s1", {"n"}, Simulation::create(to_scene(mixed_scene_text())).value(),
                     environment);
    try {
      const ActionResult result =
          read_restore(params_of_restore(state))(core, core.participants().ghost(1));
      const auto* error = std::get_if<RpcError>(&result);
      return error == nullptr ? "" : error->data.at("limit").get<std::string>();
    } catch (const StorageError& error) {
      return error.what();
    }
  }
  /// Of a session that has more bodies than its scene.
  SavedState grown() {
    Simulation simulation = Simulation::create(to_scene(mixed_scene_text())).value();
    const Snapshot as_loaded = simulation.snapshot();
    BodyDescription body = simulation.scene().bodies.back();
    body.name = "second";
    body.position = {0.3, 0.7, 0.8};
    EXPECT_TRUE(simulation.add_body(body).ok());
    return make_saved_state({simulation.snapshot(), as_loaded, 3, {}}, "n", "Ann");
  }

  const Simulation scene_;
  LoneEnvironment environment_;
};

TEST_F(SavedStateEntries, AreUnpackedUpToWhatASessionMayBe) {
  const std::size_t most = most_state_bytes(environment_.limits);
  ASSERT_LT(most, std::size_t{1} << 30);
  SavedState state = grown();
  EXPECT_EQ(fault(state), "");
  state.state = bytes_that_say(static_cast<std::uint32_t>(most));
  EXPECT_THAT(fault(state), HasSubstr("incorrect"));
  state.state = bytes_that_say(static_cast<std::uint32_t>(most + 1));
  EXPECT_THAT(fault(state), HasSubstr("too large"));
}

TEST_F(SavedStateEntries, HaveNoMoreParticlesThanASessionMay) {
  const std::size_t particles = resources_of(scene_).particles;
  EXPECT_EQ(fault(grown(), particles), "particles_in_all");
  environment_.limits.max_particles = particles;
  EXPECT_EQ(fault(grown()), "particles");
}

TEST_F(SavedStateEntries, ThatAreNoObjectAreDamaged) {
  SavedState state = grown();
  state.fields = "[]";
  EXPECT_THAT(fault(state), HasSubstr("no object"));
}

}  // namespace
}  // namespace vat::test::saved_state_test
