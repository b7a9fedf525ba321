#include "tests/recovery/past.h"

#include <gtest/gtest.h>

#include <limits>

#include "protocol/messages/describe.h"
#include "server/replay/log_replay.h"
#include "server/session/core/scene_loading.h"
#include "tests/support/lone_environment.h"

namespace vat::test {

std::map<std::string, StoredPast> read_past(const std::string& data_folder) {
  std::map<std::string, StoredPast> all;
  SessionStore store(data_folder + "/vat.db");
  for (const StoredSession& session : store.sessions()) {
    StoredPast& past = all["s" + std::to_string(session.number)];
    past.name = session.name;
    past.position = session.reached;
    for (auto part = store.read(session.number, 0); !part.empty();
         part = store.read(session.number, past.log.back().sequence)) {
      past.log.insert(past.log.end(), part.begin(), part.end());
    }
    past.position = std::max(past.position, past.log.back().position);
  }
  return all;
}

std::map<std::uint64_t, std::set<std::string>> hashes_of(const StoredPast& past,
                                                         const Catalogue& catalogue) {
  LoneEnvironment lone(catalogue);
  lone.limits.max_particles = lone.limits.max_springs = lone.limits.max_particle_steps_per_tick =
      lone.limits.max_grabs_per_client = std::numeric_limits<std::size_t>::max();
  const SessionEnvironment& environment = lone.shared;
  const std::atomic<bool> never = false;
  const Json params = Json::parse(past.log.front().params);
  const Scene scene = std::get<Scene>(read_client_scene(params.at("scene"), catalogue));
  SessionCore core(
      "s", {past.name, Role::controller, false, 0},
      std::get<Simulation>(make_simulation(scene, environment, environment.instructions)),
      environment);

  std::map<std::uint64_t, std::set<std::string>> hashes;
  const auto note = [&] {
    hashes[core.run().position()].insert(describe_hash(core.run().simulation().state_hash()));
  };
  const auto run = [&](std::uint64_t position) {
    while (core.run().position() < position) {
      run_to(core, core.run().position() + 1, never);
      note();
    }
  };
  note();
  for (std::size_t i = 1; i < past.log.size(); ++i) {
    run(past.log[i].position);
    try {
      repeat_entry(core, past.log[i]);
    } catch (const Diverged&) {
      // If a kill ended the server between the storing of a last entry and its refusal, the log
      // does not contain the refusal; see SessionRecovery.
      EXPECT_EQ(past.log[i].position, past.log.back().position);
    }
    note();
  }
  run(past.position);
  return hashes;
}

}  // namespace vat::test
