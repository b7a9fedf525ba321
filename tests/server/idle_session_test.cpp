// What a session costs in which nothing happens.

#include <chrono>
#include <ctime>
#include <iostream>
#include <thread>

#include "tests/server/session_fixture.h"
#include "tests/support/patience.h"

namespace vat::test::idle_session_test {
namespace {

double processor_seconds() {
  timespec used{};
  EXPECT_EQ(clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &used), 0);
  return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
}

class IdleSession : public SessionTest {};

// With one who watches: statuses go on.
TEST_F(IdleSession, CostsLessThanAThousandthOfACore) {
  constexpr std::chrono::seconds kWatch(3);
  client->result("frames.subscribe");
  client->wait_frame([](const GridFrame&) { return true; });
  std::this_thread::sleep_for(std::chrono::milliseconds(100));  // what was under way has ended
  const double before = processor_seconds();
  std::this_thread::sleep_for(kWatch);
  EXPECT_LT(processor_seconds() - before, 1e-3 * kSlowdown * static_cast<double>(kWatch.count()));
}

constexpr int kPaused = 100;

class PausedSessions : public SessionTest {
 protected:
  static ServerLimits limits() {
    ServerLimits limits = unhurried();
    limits.max_sessions = limits.max_sessions_per_address = 1 + kPaused;
    return limits;
  }
  PausedSessions() : SessionTest(limits()) {}
};

// Each looks twice a second whether somebody has gone: 100 us for that are far too much.
TEST_F(PausedSessions, CostNextToNothing) {
  constexpr std::chrono::seconds kWatch(3);
  constexpr double kPerSecond = 2 * 100e-6 * kPaused * kSlowdown;
  for (int i = 0; i < kPaused; ++i) {
    const Json params{{"name", "n"}, {"scene", "mixed"}};
    const auto owner = join(client->result("session.create", params).at("session"));
    owner->result("control.pause");
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(100));  // what was under way has ended
  const double before = processor_seconds();
  std::this_thread::sleep_for(kWatch);
  const double used = processor_seconds() - before;
  std::cout << kPaused << " paused sessions used " << 1e3 * used << " ms of a core in "
            << kWatch.count() << " s\n";
  EXPECT_LT(used, kPerSecond * static_cast<double>(kWatch.count()));
}

}  // namespace
}  // namespace vat::test::idle_session_test
