#include "server/session/core/session_restore.h"

#include <utility>

#include "core/support/check.h"
#include "server/support/log.h"

namespace vat {
namespace {

/// Greater than the number of epochs that clients may have seen after the last stored one.
constexpr std::uint32_t kSkippedEpochs = 1000;

}  // namespace

void resume(SessionCore& core, const SessionMoment& moment, Simulation simulation,
            Snapshot as_loaded) {
  VAT_CHECK(core.owner().allows_this_thread());
  core.run().resume(std::move(simulation), std::move(as_loaded), moment);
  core.notifier().reset_frames();
  core.history().set_sequences(moment.sequence, moment.loaded);
  core.clock().set(moment.playing, moment.speed);
  core.participants() = {};
  read_participants(moment.participants, core.participants());
}

void apply_progress(SessionCore& core, const SessionProgress& progress) {
  core.clock().set(progress.playing, progress.speed);
  Participants participants;
  const Result<Json> json = parse_json(
      progress.participants, {progress.participants.size(), 16, progress.participants.size()});
  if (!json) throw StorageError(StorageError::Kind::corrupt, "a stored session: participants");
  read_participants(json.value(), participants);
  core.participants() = std::move(participants);
}

void diverge(SessionCore& core, Divergence divergence) {
  log_error("session {}: paused; the recovered state differs from the stored one: {}", core.id(),
            divergence.reason);
  core.history().set_divergence(std::move(divergence));
  core.set_playing(false);
}

void end_recovery(SessionCore& core, SteadyClock::time_point now) {
  VAT_CHECK(core.owner().allows_this_thread());
  core.clock().take_interruption();
  core.run().skip_epochs(kSkippedEpochs);
  core.notifier().start_epoch();
  if (core.history().divergence()) {
    const ParticipantNumber last = core.participants().last_number();
    core.participants() = {};
    core.participants().skip_to(last);
    return;
  }
  core.people().recover(now);
}

}  // namespace vat
