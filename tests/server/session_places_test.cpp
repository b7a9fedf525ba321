// Sessions whose ticks take long, and the places for such ticks.

#include <gtest/gtest.h>

#include "server/session/scene_loading.h"
#include "server/session/session.h"
#include "tests/server/session_fixture.h"
#include "tests/support/lone_environment.h"

namespace vat::test::session_places_test {
namespace {

using namespace std::chrono_literals;

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
    sessions_.push_back(std::make_shared<Session>("s", SessionSettings{"n"}, std::move(simulation),
                                                  std::move(share), environment_.shared, pool_,
                                                  places));
    sessions_.back()->start();
    return sessions_.back();
  }
  void run_ticks(int count) { environment_.clock.advance(count * 20ms); }

  LongTicks places{1};

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
  LongTicks::Place taken = places.take([](const LongTicks::Place&) {});
  ASSERT_NE(taken, nullptr) << "a place is given back after each tick";
  run_ticks(3);
  EXPECT_EQ(heavy->summary().tick, 2U);
  EXPECT_EQ(light->summary().tick, 5U);
  taken.reset();
  run_ticks(1);
  EXPECT_GE(heavy->summary().tick, 3U);
  EXPECT_EQ(light->summary().tick, 6U);
}

}  // namespace
}  // namespace vat::test::session_places_test
