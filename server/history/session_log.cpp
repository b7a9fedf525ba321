#include "server/history/session_log.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "core/support/check.h"
#include "server/support/stage_clock.h"

namespace vat {
namespace {

constexpr auto kProgressInterval = std::chrono::seconds(1);

std::size_t bytes_of(std::span<const LogEntry> entries) {
  std::size_t bytes = 0;
  for (const LogEntry& entry : entries) bytes += entry.params.size();
  return bytes;
}

}  // namespace

bool CheckpointPace::is_due(Seconds cost) const {
  return work_ >= std::min(std::max(wanted_, cost / kMaxShare), kMaxWork);
}

SessionLog::SessionLog(Storage& storage, std::uint64_t session, const Place& place)
    : storage_(storage),
      session_(session),
      last_(place.last),
      pace_(storage.limits().checkpoint_after),
      stored_position_(place.position),
      stored_last_(place.last),
      needs_checkpoint_(place.needs_checkpoint) {
  writing_->log_bytes = storage.sessions().log_bytes(session);
  storage.checkpoints().drop_hashes(session, place.position);
}

template <class Write>
void SessionLog::write_now(const Write& write) {
  try {
    write();
  } catch (const StorageError&) {
    storage_.count_failure();
    throw;
  }
}

void SessionLog::append(std::span<LogEntry> entries) {
  VAT_CHECK(!entries.empty());
  for (std::size_t i = 0; i < entries.size(); ++i) entries[i].sequence = last_ + 1 + i;
  write_now([&] { storage_.sessions().append(session_, entries); });
  last_ += entries.size();
  writing_->log_bytes += bytes_of(entries);
}

void SessionLog::refuse(std::uint64_t sequence) {
  VAT_CHECK(sequence > 0 && sequence <= last_);
  write_now([&] { storage_.sessions().refuse(session_, sequence); });
}

void SessionLog::configure(const std::string& name, const std::string& settings) {
  write_now([&] { storage_.sessions().configure(session_, name, settings); });
}

void SessionLog::reach(std::uint64_t position) {
  write_now([&] { storage_.sessions().reach(session_, position); });
}

bool SessionLog::is_checkpoint_due() const {
  return needs_checkpoint_ || pace_.is_due(CheckpointPace::Seconds(writing_->checkpoint_cost));
}

bool SessionLog::is_due(std::uint64_t position, std::uint64_t people,
                        SteadyClock::time_point now) const {
  if (writing_->under_way) return false;
  // The stored progress of a diverged session stays until somebody continues it.
  const bool people_are_stored = needs_checkpoint_ || people == stored_people_;
  if (position == stored_position_ && last_ == stored_last_ && people_are_stored) return false;
  return now - stored_at_ >= kProgressInterval || is_checkpoint_due();
}

void SessionLog::store(SessionMoment moment, SteadyClock::time_point now, bool always) {
  VAT_CHECK(moment.sequence <= last_);
  const bool with_checkpoint = always || is_checkpoint_due();
  const bool needed_checkpoint = needs_checkpoint_;
  if (with_checkpoint) {
    pace_.begin();
    needs_checkpoint_ = false;
  }
  stored_position_ = moment.position;
  stored_last_ = last_;
  stored_people_ = moment.people;
  stored_at_ = now;
  writing_->under_way = true;
  storage_.post([&storage = storage_, session = session_, moment = std::move(moment),
                 hashes = std::exchange(hashes_, {}), with_checkpoint, writing = writing_] {
    // A failed write must not prevent the next one.
    const std::shared_ptr<void> end(nullptr, [&](void*) { writing->under_way = false; });
    write(storage, session, moment, with_checkpoint, *writing);
    storage.checkpoints().write_hashes(session, hashes);
  });
  if (needed_checkpoint) storage_.flush();  // later entries depend on it
}

void SessionLog::store_then(SessionMoment moment, SteadyClock::time_point now,
                            std::function<void(Storage&, std::uint64_t)> task) {
  store(std::move(moment), now, true);
  storage_.post([&storage = storage_, session = session_, task = std::move(task)] {
    task(storage, session);
  });
}

void SessionLog::write(Storage& storage, std::uint64_t session, const SessionMoment& moment,
                       bool with_checkpoint, Writing& writing) {
  storage.sessions().write_progress(session, moment.progress());
  if (!with_checkpoint) return;
  const auto begin = thread_time();
  storage.checkpoints().write(
      {session, moment.position, moment.sequence, moment.fields(), moment.snapshot.to_bytes()});
  // Processor time, without waits that do not delay other sessions.
  const CheckpointPace::Seconds cost = thread_time() - begin;
  writing.checkpoint_cost = cost.count();
  storage.count_checkpoint(cost);
  bound_log(storage, session, moment, writing);
}

void SessionLog::bound_log(Storage& storage, std::uint64_t session, const SessionMoment& moment,
                           Writing& writing) {
  if (writing.log_bytes <= storage.limits().log_bytes) return;
  storage.sessions().trim(session, moment.sequence, moment.loaded);
  // Entries that were appended meanwhile are counted twice, until the next trim.
  writing.log_bytes = storage.sessions().log_bytes(session);
  spdlog::info("session s{}: its log was full, and begins at its newest checkpoint now", session);
}

}  // namespace vat
