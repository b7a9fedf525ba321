#include "tests/bench/cluster/following_viewers.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace vat::bench {
namespace {

using std::chrono::steady_clock;

constexpr std::chrono::milliseconds kSightInterval(20);
constexpr std::chrono::minutes kSightPatience(2);

}  // namespace

FollowingViewers::FollowingViewers(const ClusterNodes& nodes, std::size_t count) : sights_(count) {
  for (std::size_t viewer = 0; viewer < count; ++viewer) {
    threads_.emplace_back([this, &nodes, viewer] { watch(nodes, viewer); });
  }
  try {
    wait_for_frames();
  } catch (...) {
    ended_ = true;
    for (std::thread& thread : threads_) thread.join();
    throw;
  }
  take_pauses();
}

FollowingViewers::~FollowingViewers() {
  ended_ = true;
  for (std::thread& thread : threads_) thread.join();
}

void FollowingViewers::watch(const ClusterNodes& nodes, std::size_t viewer) {
  try {
    ClusterViewer watcher(nodes);
    watcher.join(viewer % nodes.size());
    while (!ended_) {
      note(viewer, watcher.last_frame());
      watcher.follow();
    }
  } catch (...) {
    const std::lock_guard lock(mutex_);
    failure_ = std::current_exception();
  }
}

void FollowingViewers::note(std::size_t viewer, steady_clock::time_point frame) {
  const std::lock_guard lock(mutex_);
  Sight& sight = sights_[viewer];
  if (sight.last_frame != steady_clock::time_point()) {
    const double pause = std::chrono::duration<double>(frame - sight.last_frame).count();
    sight.longest_pause = std::max(sight.longest_pause, pause);
  }
  sight.last_frame = frame;
}

void FollowingViewers::wait_for_frames() {
  const auto begin = steady_clock::now();
  for (;;) {
    {
      const std::lock_guard lock(mutex_);
      if (failure_) std::rethrow_exception(failure_);
      if (std::ranges::all_of(sights_, [&](const Sight& s) { return s.last_frame > begin; }))
        return;
    }
    if (steady_clock::now() > begin + kSightPatience) {
      throw std::runtime_error("a viewer receives no frames any more");
    }
    std::this_thread::sleep_for(kSightInterval);
  }
}

std::vector<double> FollowingViewers::take_pauses() {
  const std::lock_guard lock(mutex_);
  std::vector<double> pauses;
  for (Sight& sight : sights_) pauses.push_back(std::exchange(sight.longest_pause, 0));
  return pauses;
}

}  // namespace vat::bench
