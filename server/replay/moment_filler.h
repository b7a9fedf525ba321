#pragma once

#include <atomic>
#include <memory>
#include <thread>

#include "server/replay/moment_cache.h"
#include "server/session/core/session_environment.h"

namespace vat {

/// Thread of the lowest priority that plays a recording and stores moments, so that seeks are fast.
/// Starts with the greatest gaps between the recorded moments.
class MomentFiller {
 public:
  /// The objects to which `environment` refers must outlive the filler.
  MomentFiller(std::shared_ptr<const Recording> recording, const SessionEnvironment& environment,
               std::shared_ptr<MomentCache> moments);
  /// Ends the thread after its current tick.
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
