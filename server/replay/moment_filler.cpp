#include "server/replay/moment_filler.h"

#include <sys/resource.h>

#include <algorithm>
#include <exception>
#include <utility>
#include <vector>

#include "server/replay/replay_player.h"
#include "server/support/log.h"
#include "server/support/stage_clock.h"

namespace vat {
namespace {

constexpr int kFillerNiceness = 19;

struct Gap {
  std::uint64_t begin = 0;
  std::uint64_t end = 0;
  std::uint64_t ticks() const { return end - begin; }
};

std::vector<Gap> find_gaps(const Recording& recording) {
  std::vector<Gap> gaps;
  std::uint64_t begin = recording.begin;
  for (const RecordedMoment& moment : recording.moments) {
    gaps.push_back({begin, moment.position});
    begin = moment.position;
  }
  gaps.push_back({begin, recording.end});
  std::ranges::stable_sort(gaps, std::ranges::greater(), &Gap::ticks);
  return gaps;
}

}  // namespace

MomentFiller::MomentFiller(std::shared_ptr<const Recording> recording,
                           const SessionEnvironment& environment,
                           std::shared_ptr<MomentCache> moments)
    : recording_(std::move(recording)), moments_(std::move(moments)) {
  thread_ = std::thread([this, environment] {
    try {
      run(environment);
    } catch (const Cancelled&) {
      return;
    } catch (const std::exception& error) {
      // A viewer that plays it there receives the error. Earlier positions remain usable.
      log_info("a recording cannot be filled further: {}", error.what());
    }
    is_done_ = true;
  });
}

MomentFiller::~MomentFiller() {
  cancelled_ = true;
  thread_.join();
}

void MomentFiller::run(const SessionEnvironment& shared) {
  setpriority(PRIO_PROCESS, 0, kFillerNiceness);  // of a thread, on Linux
  ThreadPoolRunner runner(1);
  ServerMetrics metrics;  // not counted as ticks of a session
  ResourceBudget resources(kUnlimitedResources);
  const SessionEnvironment environment{
      shared.catalogue, shared.limits, shared.instructions,  runner,
      metrics,          resources,     shared.frame_threads, shared.read_threads,
      shared.tokens,    shared.clock,  shared.methods};
  ReplayPlayer player(*recording_, environment);
  player.share(moments_);
  SessionCore core("filling", {recording_->name}, player.begin(), environment);
  player.go_to_begin(core);
  MomentCache::Seconds work{0};
  std::uint64_t ticks = 0;
  for (const Gap& gap : find_gaps(*recording_)) {
    const double expected = ticks == 0 ? 1 : static_cast<double>(gap.ticks()) / double(ticks);
    if (gap.ticks() < 2 || (ticks > 0 && expected * work < moments_->work())) continue;
    player.seek(core, gap.begin, cancelled_);
    const auto begin = thread_time();
    player.play_to(core, gap.end, cancelled_);
    work += thread_time() - begin;
    ticks += gap.ticks();
  }
}

}  // namespace vat
