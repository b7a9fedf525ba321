#include "server/session/core/session_history.h"

#include <utility>

#include "core/support/check.h"

namespace vat {

SessionHistory::SessionHistory(const SessionContext& context, const SessionRun& run,
                               const SessionClock& clock, const Participants& participants)
    : context_(context), run_(run), clock_(clock), participants_(participants) {}

void SessionHistory::keep_in(std::unique_ptr<SessionLog> log) {
  VAT_CHECK(log != nullptr && log_ == nullptr);
  log_ = std::move(log);
}

void SessionHistory::set_sequences(std::uint64_t sequence, std::uint64_t scene_sequence) {
  sequence_ = sequence;
  scene_sequence_ = scene_sequence;
}

std::span<const GovernorPoint> SessionHistory::governor_points() const {
  const GovernorPermission& permission = context_.settings.governor;
  if (permission.scene != scene_sequence_) return {};
  return permission.points;
}

LogEntry SessionHistory::make_entry(ParticipantNumber participant, std::string_view method,
                                    std::string params) const {
  return {0,    run_.position(), run_.tick(), participant, std::string(method), std::move(params),
          false};
}

void SessionHistory::number(std::span<LogEntry> entries) {
  VAT_CHECK(context_.owner.allows_this_thread());
  if (log_ == nullptr) {
    // Commands of a replay's viewers are not part of the recording.
    const bool counts = context_.playback == nullptr;
    for (std::size_t i = 0; i < entries.size(); ++i) {
      entries[i].sequence = sequence_ + (counts ? 1 + i : 0);
    }
    return;
  }
  if (divergence_ && !entries.empty()) {
    // The log does not lead to this state. The next entry needs a checkpoint before it.
    sequence_ = log_->last();
    log_->store(moment(), context_.environment->clock.now(), true);
  }
  log_->number(entries);
}

std::optional<RpcError> SessionHistory::note_write(std::optional<StorageError::Kind> failure) {
  VAT_CHECK(context_.owner.allows_this_thread());
  failing_changed_ = failing_changed_ || failing_.has_value() != failure.has_value();
  failing_ = failure;
  if (!failure) return {};
  return storage_failed(*failure);
}

void SessionHistory::refuse(const LogEntry& entry) {
  if (log_ != nullptr) log_->refuse(entry.sequence);
}

SessionMoment SessionHistory::moment() const {
  VAT_CHECK(context_.owner.allows_this_thread());
  return {run_.position(),
          run_.tick(),
          sequence_,
          scene_sequence_,
          run_.last_grab(),
          run_.epoch(),
          clock_.playing(),
          clock_.speed(),
          participants_.changes(),
          run_.has_lost_device(),
          write_participants(participants_),
          run_.simulation().snapshot()};
}

}  // namespace vat
