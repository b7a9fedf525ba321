#include "tests/bench/cluster/following_viewers.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace vat::bench {
namespace {

using std::chrono::steady_clock;

constexpr std::chrono::minutes kSightPatience(2);

}  // namespace

FollowingViewers::FollowingViewers(const ClusterNodes& nodes, std::size_t count) : sights_(count) {
  for (std::size_t viewer = 0; viewer < count; ++viewer) {
    threads_.emplace_back([this, &nodes, viewer] { watch(nodes, viewer); });
  }
  try {
    wait_for_frames();
  } catch (...) {
    end();
    throw;
  }
  take_pauses();
}

FollowingViewers::~FollowingViewers() {
  end();
}

void FollowingViewers::end() {
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
    changed_.notify_all();
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
  changed_.notify_all();
}

void FollowingViewers::wait_for_frames() {
  const auto begin = steady_clock::now();
  std::unique_lock lock(mutex_);
  const bool has_changed = changed_.wait_for(lock, kSightPatience, [&] {
    return failure_ || std::ranges::all_of(
                           sights_, [&](const Sight& sight) { return sight.last_frame > begin; });
  });
  if (failure_) std::rethrow_exception(failure_);
  if (!has_changed) throw std::runtime_error("a viewer receives no frames any more");
}

std::vector<double> FollowingViewers::take_pauses() {
  const std::lock_guard lock(mutex_);
  std::vector<double> pauses;
  for (Sight& sight : sights_) pauses.push_back(std::exchange(sight.longest_pause, 0));
  return pauses;
}

}  // namespace vat::bench
