#pragma once

#include <atomic>
#include <memory>
#include <thread>

#include "server/replay/kept_moments.h"
#include "server/session/session_environment.h"

namespace vat {

/// Plays a recording beside who watches it, on a thread that gives way to all others, and keeps
/// moments where there are too few, so that going anywhere takes little time: the widest gaps
/// first.
class MomentFiller {
 public:
  /// What the environment is made of must outlive this.
  MomentFiller(std::shared_ptr<const Recording> recording, const SessionEnvironment& environment,
               std::shared_ptr<KeptMoments> moments);
  /// Ends at the next tick.
  ~MomentFiller();
  MomentFiller(const MomentFiller&) = delete;
  MomentFiller& operator=(const MomentFiller&) = delete;

  bool is_done() const { return is_done_; }

 private:
  void run(const SessionEnvironment& environment);

  const std::shared_ptr<const Recording> recording_;
  const std::shared_ptr<KeptMoments> moments_;
  std::atomic<bool> cancelled_ = false;
  std::atomic<bool> is_done_ = false;
  std::thread thread_;
};

}  // namespace vat
