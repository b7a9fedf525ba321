
#include <thread>

#include "server/session/core/scene_loading.h"
#include "server/session/session.h"
#include "server/session/ticks/slow_tick_gate.h"
#include "tests/server/fixture/session_fixture.h"
#include "tests/support/lone_environment.h"

namespace vat::test::long_ticks_test {
namespace {

using namespace std::chrono_literals;

TEST(SlowTickGate, AWaitingSessionGetsTheFirstFreePlace) {
  SlowTickGate ticks(2);
  std::vector<int> order;
  std::vector<SlowTickGate::Place> given;
  const auto wake = [&](int who) {
    return [&, who](SlowTickGate::Place place) {
      order.push_back(who);
      given.push_back(std::move(place));
    };
  };
  SlowTickGate::Place first = ticks.take(wake(1));
  SlowTickGate::Place second = ticks.take(wake(2));
  EXPECT_NE(first, nullptr);
  EXPECT_NE(second, nullptr);
  EXPECT_EQ(ticks.take(wake(3)), nullptr);
  EXPECT_EQ(ticks.take(wake(4)), nullptr);
  second.reset();
  EXPECT_EQ(order, (std::vector<int>{3}));
  EXPECT_EQ(ticks.take(wake(5)), nullptr) << "not the first in the queue";
  first.reset();
  EXPECT_EQ(order, (std::vector<int>{3, 4}));
  std::vector<SlowTickGate::Place> gone = std::move(given);
  given.clear();
  gone.clear();
  EXPECT_EQ(order, (std::vector<int>{3, 4, 5}));
  EXPECT_NE(ticks.take(wake(6)), nullptr);
  given.clear();
}

TEST(SlowTickGate, AnUnusedPlaceGoesToTheNext) {
  SlowTickGate ticks(1);
  SlowTickGate::Place place = ticks.take([](const SlowTickGate::Place&) {});
  bool came = false;
  ticks.take([](const SlowTickGate::Place&) {});  // has been released meanwhile
  ticks.take([&](const SlowTickGate::Place&) { came = true; });
  place.reset();
  EXPECT_TRUE(came);
}

TEST(SlowTickGate, NeverMoreAtOnceThanThereArePlaces) {
  constexpr int kPlaces = 3;
  SlowTickGate ticks(kPlaces);
  std::atomic<int> now = 0;
  std::atomic<int> most = 0;
  std::atomic<int> done = 0;
  const auto work = [&] {
    const int count = ++now;
    int seen = most;
    while (seen < count && !most.compare_exchange_weak(seen, count)) {
    }
    std::this_thread::yield();
    --now;
    ++done;
  };
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < 8; ++t) {
      threads.emplace_back([&] {
        for (int i = 0; i < 1000; ++i) {
          const SlowTickGate::Place place = ticks.take([&](const SlowTickGate::Place&) { work(); });
          if (place != nullptr) work();
        }
      });
    }
  }
  EXPECT_EQ(done, 8000);
  EXPECT_LE(most, kPlaces);
}

// Sessions with slow ticks, and the slots for such ticks.

/// A block of liquid whose ticks take tens of milliseconds.
Scene heavy_scene() {
  Json scene = Json::parse(mixed_scene_text());
  scene["vat"]["max"] = {2, 2, 2};
  scene["materials"][0]["liquid"]["support_radius"] = 0.07;
  scene["bodies"] = Json::array({scene["bodies"][0]});
  scene["bodies"][0]["spacing"] = 0.035;
  scene["bodies"][0]["shape"] = {{"type", "box"}, {"center", {1, 1, 0.6}}, {"size", {1, 1, 1}}};
  return to_scene(scene.dump());
}

class SessionPlaces : public testing::Test {
 protected:
  ~SessionPlaces() override {
    for (const auto& session : sessions_) session->close(Session::End::closed, {});
    pool_.join();
  }
  std::shared_ptr<Session> start(const Scene& scene) {
    Simulation simulation = Simulation::create(scene).value();
    auto share = environment_.shared.resources.take_anyway(resources_of(simulation));
    auto core = std::make_unique<SessionCore>("s", SessionSettings{"n"}, std::move(simulation),
                                              std::move(share), environment_.shared);
    sessions_.push_back(std::make_shared<Session>(std::move(core), nullptr, pool_, places));
    sessions_.back()->start();
    return sessions_.back();
  }
  void run_ticks(int count) { environment_.clock.advance(count * 20ms); }

  SlowTickGate places{1};

 private:
  const LoneEnvironment environment_;
  boost::asio::thread_pool pool_{2};
  std::vector<std::shared_ptr<Session>> sessions_;
};

TEST_F(SessionPlaces, ALongTickWaitsForItsPlaceAndAShortOneDoesNot) {
  const auto heavy = start(heavy_scene());
  const auto light = start(to_scene(mixed_scene_text()));
  run_ticks(2);
  EXPECT_EQ(heavy->summary().tick, 2U);
  SlowTickGate::Place taken = places.take([](const SlowTickGate::Place&) {});
  ASSERT_NE(taken, nullptr) << "each tick releases its slot";
  run_ticks(3);
  EXPECT_EQ(heavy->summary().tick, 2U);
  EXPECT_EQ(light->summary().tick, 5U);
  taken.reset();
  run_ticks(1);
  EXPECT_GE(heavy->summary().tick, 3U);
  EXPECT_EQ(light->summary().tick, 6U);
}

}  // namespace
}  // namespace vat::test::long_ticks_test
