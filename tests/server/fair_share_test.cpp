// A session that asks for far more than the machine can do takes nothing from those that ask for
// little.

#include <algorithm>
#include <chrono>
#include <ctime>
#include <iostream>
#include <thread>

#include "tests/server/session_fixture.h"

namespace vat::test::fair_share_test {
namespace {

using Seconds = std::chrono::duration<double>;

constexpr int kLight = 20;
constexpr std::size_t kThreads = 2;  // of the fixture's server
constexpr double kHeavySpeed = 4;
constexpr double kPeriod = 0.02;  // of the light sessions' ticks [s]
constexpr int kRounds = 3;
constexpr int kMostRounds = 12;  // where the first ones do not show it
constexpr std::chrono::seconds kWatch(1);

/// A block of liquid whose ticks take many times their period.
Json heavy_scene() {
  Json scene = Json::parse(mixed_scene_text());
  scene["name"] = "heavy";
  scene["vat"]["max"] = {2, 2, 2};
  scene["materials"][0]["liquid"]["support_radius"] = 0.07;
  scene["bodies"] = Json::array({scene["bodies"][0]});
  scene["bodies"][0]["spacing"] = 0.035;
  scene["bodies"][0]["shape"] = {{"type", "box"}, {"center", {1, 1, 0.6}}, {"size", {1, 1, 1}}};
  return scene;
}

/// How the light sessions fare over a while.
struct Rate {
  double p99 = 0;      ///< of the time between a session's consecutive ticks [s]
  double slowest = 0;  ///< least share of their ticks that a session has had
  double cores = 0;    ///< that all sessions together have used
};

double processor_seconds() {
  timespec used{};
  EXPECT_EQ(clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &used), 0);
  return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
}

class FairShare : public SessionTest {
 protected:
  static ServerLimits limits() {
    ServerLimits limits = unhurried();
    limits.max_sessions = limits.max_sessions_per_address = 2 * kLight;
    return limits;
  }
  FairShare() : SessionTest(limits()) {
    for (int i = 0; i < kLight; ++i) light.push_back(join_new("mixed"));
  }

  std::unique_ptr<TestClient> join_new(const Json& scene) {
    const Json params{{"name", "n"}, {"scene", scene}};
    return join(client->result("session.create", params).at("session"));
  }
  std::vector<std::uint64_t> ticks() {
    std::vector<std::uint64_t> all;
    for (const auto& one : light) all.push_back(one->result("session.hash").at("tick"));
    return all;
  }
  Rate watch() {
    const auto begin = std::chrono::steady_clock::now();
    const double used = processor_seconds();
    const std::vector<std::uint64_t> before = ticks();
    // Anew each time: who does not acknowledge meanwhile gets fewer frames.
    light.back()->result("frames.subscribe", {{"max_error", 0.1}});
    const std::vector<double> times = periods(*light.back());
    light.back()->result("frames.unsubscribe");
    const std::vector<std::uint64_t> after = ticks();
    const double wall = Seconds(std::chrono::steady_clock::now() - begin).count();
    Rate rate{times.empty() ? 1e9 : times[times.size() * 99 / 100], 1,
              (processor_seconds() - used) / wall};
    for (std::size_t i = 0; i < after.size(); ++i) {
      const auto had = static_cast<double>(after[i] - before[i]);
      rate.slowest = std::min(rate.slowest, had * kPeriod / wall);
    }
    return rate;
  }

  std::vector<std::unique_ptr<TestClient>> light;

 private:
  /// Times between the states of consecutive ticks that the client saw, in order of size [s].
  static std::vector<double> periods(TestClient& watcher) {
    std::vector<double> times;
    const auto end = std::chrono::steady_clock::now() + kWatch;
    GridFrame last = watcher.wait_frame([](const GridFrame&) { return true; });
    while (std::chrono::steady_clock::now() < end) {
      GridFrame next = watcher.wait_frame(
          [&](const GridFrame& frame) { return frame.header.tick > last.header.tick; });
      if (next.header.tick == last.header.tick + 1) {
        times.push_back(next.header.published - last.header.published);
      }
      last = std::move(next);
    }
    std::ranges::sort(times);
    return times;
  }
};

Rate best(Rate a, const Rate& b) {
  return {std::min(a.p99, b.p99), std::max(a.slowest, b.slowest), std::max(a.cores, b.cores)};
}

class HeavySessions : public FairShare, public testing::WithParamInterface<std::size_t> {};

INSTANTIATE_TEST_SUITE_P(Counts, HeavySessions, testing::Values(1, kThreads));

// What the light sessions have while the heavy ones play is compared with what they have while
// those are paused, in turns, and the best rounds with each other: other work on the machine comes
// and goes, but who waits for long ticks does so in every round. A round in which the heavy ones
// did not get the cores that they have work for says nothing: other programs had them.
TEST_P(HeavySessions, LeaveTheLightOnesTheirRate) {
  // The light ones and the clients have work for more than half a core.
  const double wanted = static_cast<double>(GetParam()) + 0.5;
  if (std::thread::hardware_concurrency() < wanted) {
    GTEST_SKIP() << "the system shares out the cores, of which heavy sessions take all";
  }
  std::vector<std::unique_ptr<TestClient>> heavy;
  for (std::size_t i = 0; i < GetParam(); ++i) {
    heavy.push_back(join_new(heavy_scene()));
    heavy.back()->result("control.set_speed", {{"speed", kHeavySpeed}});
  }
  Rate alone{1e9, 0, 0};
  Rate beside{1e9, 0, 0};
  double least_factor = kHeavySpeed;
  const auto keep_theirs = [&] {
    return beside.p99 < std::max(2 * kPeriod, 2 * alone.p99) &&
           beside.slowest > 0.8 * alone.slowest;
  };
  for (int round = 0; round < kRounds || (round < kMostRounds && !keep_theirs()); ++round) {
    for (const auto& one : heavy) one->result("control.play");
    const Rate now = watch();
    if (now.cores > 0.8 * wanted) beside = best(beside, now);
    for (const auto& one : heavy) {
      one->mark();
      const double factor = one->wait_event("session.status").at("real_time_factor");
      EXPECT_LT(factor, kHeavySpeed / 10) << "it must ask for far too much";
      least_factor = std::min(least_factor, factor);
    }
    for (const auto& one : heavy) one->result("control.pause");
    alone = best(alone, watch());
  }
  // Nor does a machine on which the light ones do not even have their ticks alone.
  const bool is_busy = beside.cores == 0 || (!keep_theirs() && alone.slowest < 0.95);
  if (is_busy) GTEST_SKIP() << "the machine is busy with other work";
  std::cout << GetParam() << " heavy sessions at " << least_factor << " of " << kHeavySpeed
            << " or more; light ones: period p99 " << 1e3 * alone.p99 << " ms alone, "
            << 1e3 * beside.p99 << " ms beside them; the slowest had " << 100 * alone.slowest
            << " % and " << 100 * beside.slowest << " % of its ticks\n";
  EXPECT_TRUE(keep_theirs());
}

// Nobody waits for a place much longer than another.
TEST_F(FairShare, HeavySessionsShareTheirPlaces) {
  constexpr std::uint64_t kTicks = 4;
  std::vector<std::unique_ptr<TestClient>> heavy;
  for (std::size_t i = 0; i < 2 * kThreads; ++i) {
    heavy.push_back(join_new(heavy_scene()));
    heavy.back()->result("control.pause");
    heavy.back()->result("control.reset");
  }
  for (const auto& one : heavy) one->result("control.play");
  for (const auto& one : heavy) {
    while (one->result("session.hash").at("tick") < kTicks) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }
  std::vector<std::uint64_t> had;
  for (const auto& one : heavy) had.push_back(one->result("control.pause").at("tick"));
  const auto [least, most] = std::ranges::minmax(had);
  EXPECT_LE(most, 3 * least + 3);
}

}  // namespace
}  // namespace vat::test::fair_share_test
