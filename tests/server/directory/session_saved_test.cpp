// Saved states of sessions.

#include <gmock/gmock.h>

#include "server/session/core/saved_state.h"
#include "server/session/core/scene_loading.h"
#include "server/storage/sqlite/database.h"
#include "tests/server/directory/saved_states_fixture.h"
#include "tests/support/lone_environment.h"

namespace vat::test::session_saved_test {
namespace {

using testing::HasSubstr;

const Json kFirst = {{"name", "first"}};

TEST_P(SavedStatesTest, ALoadContinuesExactly) {
  host->client->result("control.reset");
  const std::string start = host->hash();
  client().result("world.set_gravity", {{"gravity", {1, 0, -9}}});
  host->step(7);
  const Json saved = client().result("session.save", kFirst);
  EXPECT_EQ(saved.at("tick"), 7);
  EXPECT_EQ(saved.at("hash"), host->hash());
  host->step(5);
  const std::string later = host->hash();
  client().result("world.remove_body", {{"body", 2}});
  client().result("scene.load", {{"scene", "unstable"}});
  client().mark();
  EXPECT_EQ(client().result("session.load", kFirst).at("tick"), 7);
  const Json description = client().wait_event(
      "session.description", [](const Json& d) { return d.at("bodies").size() == 3; });
  EXPECT_EQ(description.at("gravity"), Json({1.0, 0.0, -9.0}));
  EXPECT_EQ(host->hash(), saved.at("hash"));
  host->step(5);
  EXPECT_EQ(host->tick(), 12U);
  EXPECT_EQ(host->hash(), later);
  client().result("control.reset");  // resets to the scene that was loaded when the state was saved
  EXPECT_EQ(host->hash(), start);
}

TEST_P(SavedStatesTest, ReleasesGrabs) {
  const std::uint64_t grab = client().grab(3);
  host->step(3);
  client().result("session.save", kFirst);
  const std::string held = host->hash();
  client().result("session.load", kFirst);
  EXPECT_NE(host->hash(), held) << "the grab of the saved state must not act";
  EXPECT_TRUE(
      client().call("grab.move", {{"grab", grab}, {"target", {0, 0, 0}}}).contains("error"));
  EXPECT_GT(client().grab(3), grab);
}

TEST_P(SavedStatesTest, AreListedReplacedAndDeleted) {
  EXPECT_TRUE(client().result("session.saves").at("states").empty());
  host->step(2);
  client().result("session.save", {{"name", "b"}});
  host->step(1);
  client().result("session.save", {{"name", "a"}});
  host->step(1);
  const std::string newest = host->hash();
  client().result("session.save", {{"name", "b"}});
  const Json states = client().result("session.saves").at("states");
  ASSERT_EQ(states.size(), 2U);
  EXPECT_EQ(states[0].at("name"), "a");
  EXPECT_EQ(states[1].at("name"), "b");
  EXPECT_EQ(states[1].at("hash"), newest);
  EXPECT_EQ(states[1].at("saved_by"), "Ada");
  EXPECT_EQ(states[1].at("at_tick").get<std::uint64_t>(), host->tick());
  client().result("session.delete_save", {{"name", "a"}});
  EXPECT_EQ(client().result("session.saves").at("states").size(), 1U);
  for (const char* method : {"session.load", "session.delete_save"}) {
    const Json error = client().error(method, {{"name", "a"}});
    EXPECT_EQ(error.at("data").at("errors")[0].at("code"), "no_such_state") << method;
    EXPECT_EQ(error.at("data").at("path"), "/name");
  }
}

TEST_P(SavedStatesTest, AreOfTheirSessionAlone) {
  client().result("session.save", kFirst);
  const std::string second = client().create_session();
  client().result("session.join", {{"session", second}});
  EXPECT_TRUE(client().result("session.saves").at("states").empty());
  client().error("session.load", kFirst);
}

TEST_P(SavedStatesTest, CountAndBytesAreLimited) {
  limits.max_states_per_session = 2;
  const std::size_t bytes = client().result("session.save", kFirst).at("bytes");
  const auto refused = [&](const std::string& name, const std::string& limit, std::size_t maximum) {
    const Json error = client().error("session.save", {{"name", name}});
    EXPECT_EQ(error.at("data").at("kind"), "limit_reached");
    EXPECT_EQ(error.at("data").at("limit"), limit);
    EXPECT_EQ(error.at("data").at("maximum"), maximum);
  };
  restart(limits);
  client().result("session.save", kFirst);
  client().result("session.save", {{"name", "second"}});
  refused("third", "states_per_session", 2);
  client().result("session.save", kFirst);  // replaces the previous state
  EXPECT_EQ(client().result("session.saves").at("states").size(), 2U);

  limits.max_states_per_session = 100;
  limits.max_state_bytes_per_session = 2 * bytes + bytes / 2;
  restart(limits);
  for (const char* name : {"first", "second"}) client().result("session.save", {{"name", name}});
  refused("third", "state_bytes_per_session", limits.max_state_bytes_per_session);

  limits.max_state_bytes_in_all = limits.max_state_bytes_per_session;
  limits.max_state_bytes_per_session *= 10;
  restart(limits);
  for (const char* name : {"first", "second"}) client().result("session.save", {{"name", name}});
  const std::string second = client().create_session();
  client().result("session.join", {{"session", second}});
  refused("third", "state_bytes_in_all", limits.max_state_bytes_in_all);
  client().result("session.join", {{"session", "s1"}});
  client().result("session.delete_save", {{"name", "second"}});
  client().result("session.save", {{"name", "third"}});
}

TEST_P(SavedStatesTest, ATooLargeOneIsNotLoadedAndChangesNothing) {
  client().result("session.save", kFirst);
  client().result("scene.load", {{"scene", "unstable"}});
  if (!GetParam()) return;  // the smaller limits need a restart that keeps states
  ServerLimits few = limits;
  few.max_particles = 10;
  restart(few);
  const std::string before = host->hash();
  EXPECT_EQ(client().error("session.load", kFirst).at("data").at("limit"), "particles");
  EXPECT_EQ(host->hash(), before);
  restart();
  EXPECT_EQ(host->hash(), before);
}

// The log contains the loaded state, because the saved state may be deleted later.
TEST_P(SavedStatesTest, ALoadAndTheSavedStateSurviveARestart) {
  host->step(4);
  client().result("session.save", kFirst);
  client().result("session.save", {{"name", "second"}});
  host->step(3);
  client().result("session.load", kFirst);
  client().result("session.delete_save", kFirst);
  host->step(2);
  const std::string before = host->hash();
  restart();
  if (!GetParam()) {
    EXPECT_TRUE(client().result("session.saves").at("states").empty());
    return;
  }
  EXPECT_EQ(host->hash(), before);
  // Without checkpoints, the server restores the session from the log alone.
  host.reset();
  Database(folder() + "/checkpoints.db", Database::Mode::create).execute("DELETE FROM checkpoints");
  restart();
  EXPECT_TRUE(client().events("session.diverged").empty());
  EXPECT_EQ(host->hash(), before);
  EXPECT_EQ(host->tick(), 6U);
  EXPECT_EQ(client().result("session.saves").at("states").size(), 1U);
  client().result("session.load", {{"name", "second"}});
  EXPECT_EQ(host->tick(), 4U);
}

TEST_P(SavedStatesTest, GoWithTheirSession) {
  const std::string second = client().create_session();
  client().result("session.join", {{"session", second}});
  client().result("session.save", kFirst);
  client().result("session.close", {{"session", second}});
  host.reset();
  if (!GetParam()) return;
  EXPECT_EQ(
      Database(folder() + "/states.db", Database::Mode::read).number("SELECT count(*) FROM states"),
      0);
}

INSTANTIATE_TEST_SUITE_P(Storage, SavedStatesTest, testing::Bool(),
                         [](const auto& test) { return test.param ? "Folder" : "Memory"; });

class SavedStateEntries : public testing::Test {
 protected:
  SavedStateEntries() : scene_(mixed_simulation()) {}

  /// Returns the error of a refused restore; for a limit, its name.
  std::string fault(const SavedState& state, std::size_t particles_in_all = 1'000'000) {
    ResourceBudget resources({particles_in_all, kUnlimitedResources.springs});
    const SessionEnvironment environment = environment_.with(resources);
    SessionCore core("s1", {"n"}, mixed_simulation(), environment);
    try {
      const ActionResult result =
          read_restore(params_of_restore(state))(core, core.participants().find_or_add(1));
      const auto* error = std::get_if<RpcError>(&result);
      return error == nullptr ? "" : error->data.at("limit").get<std::string>();
    } catch (const StorageError& error) {
      return error.what();
    }
  }
  /// Returns the state of a session that has more bodies than its scene.
  SavedState grown() {
    Simulation simulation = mixed_simulation();
    const Snapshot as_loaded = simulation.snapshot();
    BodyDescription body = simulation.scene().bodies.back();
    body.name = "second";
    body.position = {0.3, 0.7, 0.8};
    EXPECT_TRUE(simulation.add_body(body).ok());
    return make_saved_state({simulation.snapshot(), as_loaded, 3, {}}, "n", "Ann", 0);
  }

  const Simulation scene_;
  LoneEnvironment environment_;
};

TEST_F(SavedStateEntries, AreUnpackedUpToTheLimitOfASession) {
  const std::size_t most = max_state_bytes(environment_.limits);
  ASSERT_LT(most, std::size_t{1} << 30);
  SavedState state = grown();
  EXPECT_EQ(fault(state), "");
  state.state = bytes_that_say(static_cast<std::uint32_t>(most));
  EXPECT_THAT(fault(state), HasSubstr("incorrect"));
  state.state = bytes_that_say(static_cast<std::uint32_t>(most + 1));
  EXPECT_THAT(fault(state), HasSubstr("too large"));
  state.fields = "[]";
  EXPECT_THAT(fault(state), HasSubstr("no object"));
}

TEST_F(SavedStateEntries, HaveNoMoreParticlesThanASessionMay) {
  const std::size_t particles = resources_of(scene_).particles;
  EXPECT_EQ(fault(grown(), particles), "particles_in_all");
  environment_.limits.max_particles = particles;
  EXPECT_EQ(fault(grown()), "particles");
}

}  // namespace
}  // namespace vat::test::session_saved_test
