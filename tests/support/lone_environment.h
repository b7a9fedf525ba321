#pragma once

#include <boost/asio/thread_pool.hpp>
#include <cstddef>
#include <utility>

#include "server/rpc/method_table.h"
#include "server/session/core/session_environment.h"
#include "tests/support/manual_clock.h"

namespace vat::test {

/// The environment of a session without a server. Its limits may change during use.
class LoneEnvironment {
 public:
  explicit LoneEnvironment(Catalogue catalogue = {}, std::size_t threads = 1)
      : catalogue_(std::move(catalogue)), runner_(threads) {}

  /// Returns the environment with another budget.
  SessionEnvironment with(ResourceBudget& resources) {
    return {catalogue_, limits,    best_instruction_set(), runner_,
            metrics_,   resources, frame_threads_,         read_threads_,
            tokens_,    clock,     session_methods()};
  }

  ServerLimits limits;
  mutable ManualClock clock;

 private:
  const Catalogue catalogue_;
  ThreadPoolRunner runner_;
  ServerMetrics metrics_;
  ResourceBudget resources_{kUnlimitedResources};
  AccessTokens tokens_{1, clock};
  boost::asio::thread_pool frame_threads_{1};
  boost::asio::thread_pool read_threads_{1};

 public:
  const SessionEnvironment shared = with(resources_);
};

}  // namespace vat::test
