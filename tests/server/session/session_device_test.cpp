// Sessions on an OpenCL device. The test machine has the device PoCL, which computes on its
// processor.

#include <gmock/gmock.h>

#include "core/stepping/step_engine.h"
#include "tests/server/session/recovery_fixture.h"
#include "tests/support/lone_environment.h"

namespace vat::test::session_device_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using Device = std::optional<DeviceChoice>;

const Device kOfScene;
const Device kCpu = DeviceChoice{};
const Device kOpenCl = DeviceChoice{.is_cpu = false};
const Device kAuto = DeviceChoice{.is_auto = true};

/// A column of 252 particles of water that collapses, in ticks of four steps.
const Json kColumn = Json::parse(R"({
  "format": "vat.scene/1", "name": "column",
  "materials": [{"name": "water", "density": 1000,
                 "liquid": {"stiffness": 400, "viscosity": 0.01, "support_radius": 0.08}},
                {"name": "wood", "density": 500}],
  "vat": {"min": [0, 0, 0], "max": [0.6, 0.24, 0.6]},
  "bodies": [{"name": "column", "kind": "liquid", "material": "water", "spacing": 0.04,
              "shape": {"type": "box", "center": [0.13, 0.12, 0.15], "size": [0.24, 0.24, 0.28]}}],
  "numerics": {"integrator": "symplectic_euler", "step": 0.001, "tick": 0.004}})");
/// A wheel, whose axle a device supports with velocity Verlet only.
const Json kWheel = {{"name", "wheel"},
                     {"kind", "rigid"},
                     {"material", "wood"},
                     {"spacing", 0.04},
                     {"position", {0.45, 0.12, 0.45}},
                     {"shape", {{"type", "box"}, {"size", {0.08, 0.08, 0.08}}}},
                     {"axle", {{"direction", {0, 1, 0}}}}};

Json column_on(const std::string& device) {
  Json scene = kColumn;
  scene["numerics"]["device"] = device;
  return scene;
}

std::vector<std::string> paths_of(const Json& error) {
  std::vector<std::string> paths;
  for (const Json& one : error.at("data").at("errors")) paths.push_back(one.at("path"));
  return paths;
}

/// A server with a data folder, and a client in its session s1.
class SessionDevice : public testing::Test {
 protected:
  /// Starts the server. Joins the recovered session, if any.
  void start(const Device& device) {
    ServerSettings settings = test_settings(unhurried_limits(), data_);
    settings.device = device;
    server_.emplace(catalogue_, settings);
    const bool is_new = server_->recover() == 0;
    client_.emplace(*server_, 1);
    if (!is_new) client().result("session.join", {{"session", "s1"}});
  }
  /// Creates a session, which is paused at tick 0.
  void create(const Json& scene) {
    const std::string session = client().create_session(scene);
    client().result("session.join", {{"session", session}});
    client().result("control.pause");
    client().result("control.reset");
  }
  /// Ends the server as a crash does, and starts the next.
  void crash(const Device& device) {
    end_by_crash();
    start(device);
  }
  void end_by_crash() {
    const std::string next = folder_.file("data" + std::to_string(++lives_));
    server_->flush();
    copy_data(data_, next);
    client_.reset();
    server_.reset();
    data_ = next;
  }
  TestClient& client() { return *client_; }
  void step(int ticks) { client().result("control.step", {{"ticks", ticks}}); }
  std::string hash() { return client().result("session.hash").at("hash"); }
  /// Returns the device of the session; "cpu" if there is none.
  std::string device() { return client().result("session.hash").value("device", "cpu"); }
  int device_steps() { return client().result("session.stats").value("device_steps", 0); }

  const TemporaryFolder folder_;
  const Catalogue catalogue_ = make_catalogue();
  std::string data_ = folder_.file("data0");
  std::optional<TestServer> server_;
  std::optional<TestClient> client_;
  int lives_ = 0;
};

TEST_F(SessionDevice, IsThatOfTheServerOrOtherwiseThatOfTheScene) {
  struct Case {
    const char* name;
    Device setting;
    Json scene;
    std::string device;
  };
  for (const Case& one : {Case{"setting", kOpenCl, kColumn, "opencl:0"},
                          Case{"scene", kOfScene, column_on("opencl"), "opencl:0"},
                          Case{"fast", kOfScene, column_on("opencl:0:fast"), "opencl:0:fast"},
                          Case{"setting over scene", kCpu, column_on("opencl"), "cpu"},
                          Case{"neither", kOfScene, kColumn, "cpu"},
                          Case{"small, automatic", kAuto, kColumn, "cpu"}}) {
    SCOPED_TRACE(one.name);
    start(one.setting);
    create(one.scene);
    for (int loads = 0; loads < 2; ++loads) {
      step(2);
      EXPECT_EQ(device(), one.device);
      EXPECT_EQ(device_steps(), one.device == "cpu" ? 0 : 8);
      client().result("scene.load", {{"scene", one.scene}});
    }
    client_.reset();
    server_.reset();
    data_ = folder_.file("data" + std::to_string(++lives_));
  }
}

TEST_F(SessionDevice, ScenesWithOtherFeaturesAreRejected) {
  start(kOpenCl);
  create(kColumn);
  step(1);
  const std::string before = hash();
  Json scene = kColumn;
  for (const char* name : {"wheel", "second wheel"}) {
    scene["bodies"].push_back(kWheel);
    scene["bodies"].back()["name"] = name;
  }
  for (const char* method : {"session.create", "scene.load"}) {
    SCOPED_TRACE(method);
    Json params{{"scene", scene}};
    if (method == std::string("session.create")) params["name"] = "other";
    const Json error = client().error(method, params);
    EXPECT_EQ(error.at("data").at("kind"), "invalid_params");
    EXPECT_THAT(paths_of(error), ElementsAre("/scene/bodies/1/axle", "/scene/bodies/2/axle"));
  }
  EXPECT_EQ(hash(), before);
  EXPECT_EQ(device(), "opencl:0");
}

TEST_F(SessionDevice, MissingDevicesOfScenesAreErrors) {
  start(kOfScene);
  for (const char* device : {"opencl:99", "gpu"}) {
    EXPECT_THAT(
        paths_of(client().error("session.create", {{"name", "n"}, {"scene", column_on(device)}})),
        ElementsAre("/scene/numerics/device"));
  }
}

TEST_F(SessionDevice, ARestoredSessionContinuesOnItsDevice) {
  start(kOpenCl);
  create(kColumn);
  step(9);
  const std::string expected = hash();
  client().result("control.reset");
  step(5);
  const std::string before = hash();
  crash(kOfScene);
  EXPECT_EQ(hash(), before);
  step(4);
  EXPECT_EQ(hash(), expected);
  EXPECT_EQ(device(), "opencl:0");
  EXPECT_GE(device_steps(), 16);
  EXPECT_THAT(client().events("session.diverged"), IsEmpty());
}

TEST_F(SessionDevice, TheLogOfALoadedSceneContainsTheDevice) {
  start(kOpenCl);
  create(kColumn);
  client().result("scene.load", {{"scene", kColumn}});
  step(5);
  const std::string before = hash();
  crash(kOfScene);
  EXPECT_EQ(hash(), before);
  EXPECT_EQ(device(), "opencl:0");
}

TEST_F(SessionDevice, WithTheSettingCpuTheCpuContinuesStoredSessions) {
  start(kOpenCl);
  create(kColumn);
  step(5);
  crash(kCpu);
  EXPECT_EQ(device(), "cpu");
  client().wait_event("session.diverged");
  step(3);
  const std::string before = hash();
  crash(kOfScene);
  EXPECT_EQ(hash(), before);
  EXPECT_EQ(device(), "cpu");
  EXPECT_THAT(client().events("session.diverged"), IsEmpty());
}

TEST_F(SessionDevice, WithoutItsDeviceAStoredSessionIsNotRestored) {
  start(kOpenCl);
  create(kColumn);
  step(5);
  const std::string before = hash();
  end_by_crash();
  const auto rename = [&](const std::string& from, const std::string& to) {
    Database(data_ + "/vat.db", Database::Mode::create)
        .execute(("UPDATE log SET params = replace(params, '" + from + "', '" + to + "')").c_str());
  };
  rename("opencl:0", "opencl:99");
  server_.emplace(catalogue_, test_settings(unhurried_limits(), data_));
  EXPECT_EQ(server_->recover(), 1U);
  client_.emplace(*server_, 1);
  EXPECT_EQ(client().error("session.join", {{"session", "s1"}}).at("data").at("kind"),
            "not_recovered");
  end_by_crash();
  rename("opencl:99", "opencl:0");
  start(kOfScene);
  EXPECT_EQ(hash(), before);
}

TEST_F(SessionDevice, AReplayHasTheSameStates) {
  start(kOpenCl);
  create(kColumn);
  std::vector<std::pair<std::uint64_t, std::string>> states;
  for (int tick = 0; tick < 4; ++tick) {
    step(1);
    const Json state = client().result("session.hash");
    states.emplace_back(state.at("position"), state.at("hash"));
  }
  const Json opened = client().result("replay.open", {{"session", "s1"}});
  client().result("session.join", {{"session", opened.at("session")}});
  for (const int index : {3, 0, 2}) {
    const auto& [position, expected] = states[static_cast<std::size_t>(index)];
    client().result("replay.seek", {{"position", position}});
    EXPECT_EQ(hash(), expected);
    EXPECT_EQ(device(), "opencl:0");
  }
  EXPECT_THAT(client().events("replay.diverged"), IsEmpty());
}

TEST_F(SessionDevice, ASavedStateContinuesOnItsDevice) {
  start(kOpenCl);
  create(kColumn);
  step(2);
  client().result("session.save", {{"name", "early"}});
  step(3);
  const std::string later = hash();
  client().result("session.load", {{"name", "early"}});
  EXPECT_EQ(device(), "opencl:0");
  step(3);
  EXPECT_EQ(hash(), later);
  EXPECT_EQ(device_steps(), 12);
}

TEST_F(SessionDevice, TheCpuTakesTheStepsWhileTheSceneHasOtherFeatures) {
  start(kOpenCl);
  create(kColumn);
  step(1);
  client().mark();
  const Json body = client().result("world.add_body", {{"body", kWheel}}).at("body");
  step(2);
  const std::vector<Json> events = client().events("session.device");
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].at("code"), "not_on_device");
  EXPECT_EQ(events[0].at("path"), "/bodies/1/axle");
  EXPECT_EQ(device_steps(), 4);
  crash(kOfScene);
  step(1);
  client().result("world.remove_body", {{"body", body}});
  const int before = device_steps();
  step(1);
  EXPECT_EQ(device_steps(), before + 4);
  const std::string expected = hash();
  client().result("control.reset");
  step(1);
  EXPECT_EQ(device_steps(), before + 8);
  client().result("world.add_body", {{"body", kWheel}});
  step(3);
  client().result("world.remove_body", {{"body", 3}});
  step(1);
  EXPECT_EQ(hash(), expected);
}

/// An engine whose device is lost at its second call.
class LostEngine : public StepEngine {
 public:
  std::string_view arithmetic() const override { return "lost"; }
  Status bind(std::shared_ptr<const Model>, const GuardBounds&) override { return {}; }
  Result<bool> advance(const EngineInput& input, std::uint32_t steps) override {
    if (++calls_ > 1) return Error{"device_failed", "/device", "lost"};
    input.report.steps += steps;
    return true;
  }
  Status read(State&) override { return {}; }
  Status read_motions(BodyMotions&) override { return {}; }

 private:
  int calls_ = 0;
};

TEST(SessionWithALostDevice, ContinuesOnTheCpuAlsoAfterARecovery) {
  LoneEnvironment environment;
  Scene scene = to_scene(kColumn.dump());
  scene.numerics.device = kOpenCl;
  Simulation simulation = Simulation::create(scene).value();
  ASSERT_TRUE(simulation.set_engine(std::make_unique<LostEngine>()).ok());
  SessionCore core("s1", SessionSettings{"n"}, std::move(simulation), environment.shared);
  core.tick({}, false);
  EXPECT_EQ(core.run().device(), kOpenCl);
  EXPECT_FALSE(core.history().moment().on_cpu);
  core.tick({}, false);
  EXPECT_EQ(core.run().device(), kCpu);
  const SessionMoment moment = core.history().moment();
  EXPECT_TRUE(moment.on_cpu);
  EXPECT_TRUE(read_moment(moment.fields(), moment.snapshot).on_cpu);
}

}  // namespace
}  // namespace vat::test::session_device_test
