#pragma once

#include <atomic>
#include <memory>
#include <thread>

#include "server/replay/moment_cache.h"
#include "server/session/core/session_environment.h"

namespace vat {

/// Plays a recording on a thread of the lowest priority, and stores moments in its widest gaps
/// first, so that seeks are fast.
class MomentFiller {
 public:
  /// The contents of `environment` must outlive this.
  MomentFiller(std::shared_ptr<const Recording> recording, const SessionEnvironment& environment,
               std::shared_ptr<MomentCache> moments);
  /// Ends the thread at its next tick.
  ~MomentFiller();
  MomentFiller(const MomentFiller&) = delete;
  MomentFiller& operator=(const MomentFiller&) = delete;

  bool is_done() const { return is_done_; }

 private:
  void run(const SessionEnvironment& environment);

  const std::shared_ptr<const Recording> recording_;
  const std::shared_ptr<MomentCache> moments_;
  std::atomic<bool> cancelled_ = false;
  std::atomic<bool> is_done_ = false;
  std::thread thread_;
};

}  // namespace vat
