#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "tests/bench/cluster/cluster_viewer.h"

namespace vat::bench {

/// Viewers of the session "s1" that follow it from node to node, each in its own thread.
class FollowingViewers {
 public:
  /// Returns after each viewer has received a frame. Throws as ClusterViewer does.
  FollowingViewers(const ClusterNodes& nodes, std::size_t count);
  ~FollowingViewers();
  FollowingViewers(const FollowingViewers&) = delete;
  FollowingViewers& operator=(const FollowingViewers&) = delete;

  /// Waits until each viewer receives a further frame. Throws the error of a viewer that has
  /// failed.
  void wait_for_frames();
  /// Returns for each viewer the longest time between two frames since the previous call [s].
  std::vector<double> take_pauses();

 private:
  struct Sight {
    std::chrono::steady_clock::time_point last_frame{};
    double longest_pause = 0;  ///< [s]
  };
  void watch(const ClusterNodes& nodes, std::size_t viewer);
  /// Ends all threads.
  void end();
  void note(std::size_t viewer, std::chrono::steady_clock::time_point frame);

  std::atomic<bool> ended_ = false;
  std::condition_variable changed_;  // a sight or the failure
  std::mutex mutex_;                 // guards the members below
  std::vector<Sight> sights_;
  std::exception_ptr failure_;
  std::vector<std::thread> threads_;
};

}  // namespace vat::bench
