// What the threads of steps do on a machine that has other work too.

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <iostream>
#include <thread>
#include <vector>

#include "server/task_runner.h"

namespace vat::crowded_machine_test {
namespace {

using Clock = std::chrono::steady_clock;
using Milliseconds = std::chrono::duration<double, std::milli>;

constexpr std::size_t kSessions = 4;
constexpr int kTicks = 20;
constexpr int kPassesPerTick = 20;
constexpr std::size_t kBlocksPerPass = 16;
constexpr int kBlockRounds = 20'000;  // some tens of microseconds

std::size_t core_count() {
  return std::max(1U, std::thread::hardware_concurrency());
}

void compute(int rounds) {
  volatile double x = 1;
  for (int i = 0; i < rounds; ++i) x = x * 1.0000001;
}

/// Processes that compute while it lives.
class BusyProcesses {
 public:
  explicit BusyProcesses(std::size_t count) {
    while (processes_.size() < count) {
      const pid_t process = fork();
      if (process == 0) {
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        for (;;) compute(kBlockRounds);
      }
      processes_.push_back(process);
    }
  }
  ~BusyProcesses() {
    for (const pid_t process : processes_) {
      kill(process, SIGKILL);
      waitpid(process, nullptr, 0);
    }
  }
  BusyProcesses(const BusyProcesses&) = delete;
  BusyProcesses& operator=(const BusyProcesses&) = delete;

 private:
  std::vector<pid_t> processes_;
};

void tick(ThreadPoolRunner& runner) {
  for (int pass = 0; pass < kPassesPerTick; ++pass) {
    runner.run(kBlocksPerPass, [](std::size_t) { compute(kBlockRounds); });
  }
}

/// Wall time of a tick, the mean over all sessions and their ticks.
Milliseconds tick_time(ThreadPoolRunner& runner, std::size_t sessions) {
  std::vector<Milliseconds> times(sessions);
  {
    std::vector<std::jthread> threads;
    for (Milliseconds& time : times) {
      threads.emplace_back([&runner, &time] {
        const auto begin = Clock::now();
        for (int i = 0; i < kTicks; ++i) {
          const ThreadPoolRunner::Guest guest(runner);
          tick(runner);
        }
        time = (Clock::now() - begin) / kTicks;
      });
    }
  }
  Milliseconds sum{};
  for (const Milliseconds time : times) sum += time;
  return sum / static_cast<double>(sessions);
}

// With twice as many busy processes as cores a thread gets a third of one. Beyond this fair share a
// caller waits for helpers whose turn is over; that must stay a small factor, not a hundred. It is
// wide because other work may come and go between the two measurements.
TEST(CrowdedMachine, TicksSlowDownInProportion) {
  constexpr double kFairShare = 3;
  constexpr double kMostWaiting = 6;
  ThreadPoolRunner runner(core_count());
  for (const std::size_t sessions : {std::size_t{1}, kSessions}) {
    const Milliseconds alone = tick_time(runner, sessions);
    const BusyProcesses others(2 * core_count());
    const Milliseconds crowded = tick_time(runner, sessions);
    std::cout << sessions << " sessions: a tick takes " << alone.count() << " ms alone, "
              << crowded.count() << " ms beside " << 2 * core_count() << " busy processes\n";
    EXPECT_LT(crowded.count(), kFairShare * kMostWaiting * alone.count()) << sessions;
  }
}

}  // namespace
}  // namespace vat::crowded_machine_test
