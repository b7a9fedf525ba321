// What a session costs in which nothing happens.

#include <chrono>
#include <ctime>
#include <thread>

#include "tests/server/session_fixture.h"

namespace vat::test {
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
  EXPECT_LT(processor_seconds() - before, 1e-3 * static_cast<double>(kWatch.count()));
}

}  // namespace
}  // namespace vat::test
