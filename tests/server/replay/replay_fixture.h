#pragma once

#include "server/http/downloads.h"
#include "server/replay/replay_player.h"
#include "tests/server/fixture/session_fixture.h"
#include "tests/support/lone_environment.h"
#include "tests/support/temporary_folder.h"

namespace vat::test {

inline const std::atomic<bool> kGoOn = false;

/// A server that stores the session `s1` of Ann, and the environment of a replay outside the
/// server.
class ReplayTest : public testing::Test {
 protected:
  explicit ReplayTest(const ServerLimits& limits = {}, const StorageSettings& storage = {})
      : catalogue_(make_catalogue()), server_(catalogue_, settings(limits, storage)) {
    EXPECT_TRUE(server_.create_session("first", to_scene(mixed_scene_text())).ok());
    client_.emplace(server_, 1);
    client_->result("session.join", {{"name", "Ann"}});
    client_->result("control.pause");
    client_->result("control.reset");
    elsewhere_.limits.max_particles = elsewhere_.limits.max_particle_steps_per_tick = 1'000'000'000;
  }
  void TearDown() override { client_->disconnect(); }

  /// Runs commands of all kinds, with ticks between them.
  void live() {
    step(5);
    client_->result("world.set_gravity", {{"gravity", {1, 0, -5}}});
    const std::uint64_t grab = client_->grab(2);
    step(3);
    client_->result("grab.move", {{"grab", grab}, {"target", {0.4, 0.5, 0.9}}});
    step(4);
    client_->error("grab.start", {{"body", 77}, {"particle", 0}, {"target", {0, 0, 0}}});
    edit();
    remove_and_bring_back();
    client_->result("world.remove_body", {{"body", 4}});
    add("new", 0.3);
    step(6);
    add("newer", 0.7);
    client_->result("control.reset");
    add("newest", 0.3);  // this id depends on the bodies before
    step(2);
    client_->result("world.apply_force", {{"body", 3}, {"force", {0, 0, 9}}, {"duration", 0.1}});
    TestClient other(server_, 2);
    other.result("session.join", {{"session", "s1"}});
    other.grab(3);
    step(3);
    other.result("session.leave");
    step(7);
  }
  /// Removes the ball and restores it as body 4, with its motion.
  void remove_and_bring_back() {
    const Json ball = client_->result("state.query", {{"bodies", {"ball"}}}).at("bodies").at(0);
    Json motion;
    for (const char* member : {"center_of_mass", "orientation", "velocity", "angular_velocity"}) {
      motion[member] = ball.at(member);
    }
    const Json body = client_->result("scene.get").at("scene").at("bodies").at(2);
    client_->result("world.remove_body", {{"body", 3}});
    client_->result("world.add_body", {{"body", body}, {"state", motion}});
  }
  /// Runs the commands of a scene editor.
  void edit() {
    Json material = client_->result("scene.get").at("scene").at("materials").at(0);
    material["density"] = 800;
    client_->result("world.set_material", {{"material", material}});
    client_->result("world.move_vat", {{"offset", {0.2, -0.1, 0}}});
    step(2);
    client_->result("world.move_body",
                    {{"body", 2}, {"position", {0.5, 0.5, 0.8}}, {"velocity", {0.1, 0, -1}}});
    step(2);
    client_->result("world.move_vat", {{"offset", {0, 0, 0}}});
    client_->error("world.move_body", {{"body", 2}, {"position", {5, 0, 0}}});
    client_->result("world.set_numerics", {{"integrator", "heun"}, {"step", 0.001}});
    client_->error("world.set_numerics", {{"step", 0.003}});
  }
  static constexpr std::uint64_t kGrown = 5 + 3 + 4 + 2 + 2 + 6;  // two bodies added, one removed
  static constexpr std::uint64_t kTicks = kGrown + 2 + 3 + 7;

  void add(const std::string& name, double x) {
    Json ball = wooden_ball(name, {x, 0.7, 0.85});
    ball["shape"]["radius"] = 0.1;
    client_->result("world.add_body", {{"body", ball}});
  }
  void step(int ticks) { client_->result("control.step", {{"ticks", ticks}}); }
  std::string live_hash() { return client_->result("session.hash").at("hash"); }

  /// Returns the content of an exported recording. Its file can be fetched once.
  std::string exported() {
    const Json reply = client_->result("recording.export");
    const std::string path = reply.at("path");
    const auto file = server_.downloads().take(path, server_.clock().now()).value();
    EXPECT_FALSE(server_.downloads().take(path, server_.clock().now()).has_value());
    EXPECT_EQ(reply.at("bytes"), file.content.size());
    EXPECT_EQ(file.name, "s1.vatrec");
    return file.content;
  }
  Recording record() {
    const std::string bytes = exported();
    return read_recording({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()})
        .value();
  }

  /// A recording being played.
  struct Replay {
    Replay(const Recording& recording, const SessionEnvironment& environment)
        : player(recording, environment), core("replay", {"replay"}, player.begin(), environment) {
      player.on_same = [this](const RecordedHash&) { ++compared; };
      player.compare_moments();
      player.go_to_begin(core);
    }
    std::string hash() const { return hash_of(core.run().simulation()); }
    ReplayPlayer player;
    SessionCore core;
    std::size_t compared = 0;
  };

 private:
  ServerSettings settings(const ServerLimits& limits, const StorageSettings& storage) const {
    ServerSettings settings = test_settings(limits, folder_.file("data"));
    settings.storage = storage;
    return settings;
  }

 protected:
  const TemporaryFolder folder_;
  const Catalogue catalogue_;
  TestServer server_;
  std::optional<TestClient> client_;
  LoneEnvironment elsewhere_{catalogue_, 2};
  const SessionEnvironment& environment_ = elsewhere_.shared;
};

}  // namespace vat::test
