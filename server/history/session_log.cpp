#include "server/history/session_log.h"

#include <algorithm>
#include <utility>

#include "core/support/check.h"
#include "server/support/log.h"
#include "server/support/stage_clock.h"

namespace vat {
namespace {

constexpr auto kProgressInterval = std::chrono::seconds(1);
constexpr std::size_t kHashesAtOnce = 512;  // about ten seconds

std::size_t bytes_of(std::span<const LogEntry> entries) {
  std::size_t bytes = 0;
  for (const LogEntry& entry : entries) bytes += entry.params.size();
  return bytes;
}

bool is_log_full(const Storage& storage, std::size_t log_bytes) {
  return log_bytes > storage.settings().log_bytes;
}

}  // namespace

bool CheckpointPace::is_due(Seconds cost, std::size_t sessions) const {
  VAT_CHECK(sessions > 0);
  const Seconds part = wanted_ / static_cast<double>(sessions);
  return work_ >= std::min(std::max(part, cost / kMaxShare), kMaxWork);
}

SessionLog::SessionLog(Storage& storage, std::uint64_t session, const Place& place)
    : storage_(storage),
      session_(session),
      last_(place.last),
      pace_(storage.settings().checkpoint_after),
      stored_position_(place.position),
      stored_last_(place.last) {
  storage_.open_log();
  writing_->needs_checkpoint = place.needs_checkpoint;
  writing_->log_bytes = place.log_bytes;
}

void SessionLog::number(std::span<LogEntry> entries) const {
  for (std::size_t i = 0; i < entries.size(); ++i) entries[i].sequence = last_ + 1 + i;
}

void SessionLog::append(std::vector<LogEntry> entries, Journal::Done done) {
  VAT_CHECK(!entries.empty() && entries.front().sequence == last_ + 1 && done != nullptr);
  writing_->log_bytes += bytes_of(entries);
  auto write = [&storage = storage_, session = session_, entries = std::move(entries)] {
    storage.sessions().append(session, entries);
  };
  if (!writing_->needs_checkpoint) {
    storage_.journal().post(std::move(write), std::move(done));
    return;
  }
  // Behind the checkpoint, which store() has posted to the same thread.
  storage_.post([&storage = storage_, writing = writing_, write = std::move(write),
                 done = std::move(done)]() mutable {
    if (writing->needs_checkpoint) return done(StorageError::Kind::failed);
    storage.journal().post(std::move(write), std::move(done));
  });
}

void SessionLog::refuse(std::uint64_t sequence) {
  VAT_CHECK(sequence > 0 && sequence <= last_);
  // Without the mark, a recovery refuses the entry as well, unless the server's limits have
  // changed.
  storage_.journal().post([&storage = storage_, session = session_, sequence] {
    storage.sessions().refuse(session, sequence);
  });
}

void SessionLog::reach(std::uint64_t position, Journal::Done done) {
  storage_.journal().post([&storage = storage_, session = session_,
                           position] { storage.sessions().reach(session, position); },
                          std::move(done));
}

void SessionLog::configure(std::string name, std::string settings, Journal::Done done) {
  storage_.journal().post(
      [&storage = storage_, session = session_, name = std::move(name),
       settings = std::move(settings)] { storage.sessions().configure(session, name, settings); },
      std::move(done));
}

SessionLog::Stored SessionLog::due() const {
  if (writing_->needs_checkpoint) return Stored::checkpoint;
  const CheckpointPace::Seconds cost(writing_->checkpoint_cost);
  if (!pace_.is_due(cost, storage_.open_logs())) return Stored::progress;
  return storage_.admits_checkpoint() ? Stored::checkpoint : Stored::recent_state;
}

bool SessionLog::is_due(std::uint64_t position, std::uint64_t people,
                        SteadyClock::time_point now) const {
  if (writing_->under_way) return false;
  // The stored progress of a diverged session stays until somebody continues it.
  const bool people_are_stored = writing_->needs_checkpoint || people == stored_people_;
  if (position == stored_position_ && last_ == stored_last_ && people_are_stored) return false;
  return now - stored_at_ >= kProgressInterval || due() != Stored::progress;
}

void SessionLog::store(SessionMoment moment, SteadyClock::time_point now, bool always) {
  VAT_CHECK(moment.sequence <= last_);
  const Stored stored = always ? Stored::checkpoint : due();
  if (stored != Stored::progress) pace_.begin();
  stored_position_ = moment.position;
  stored_last_ = last_;
  stored_people_ = moment.people;
  stored_at_ = now;
  writing_->under_way = true;
  std::vector<TickHash> hashes;
  if (stored == Stored::checkpoint || hashes_.size() >= kHashesAtOnce) hashes.swap(hashes_);
  storage_.post([&storage = storage_, session = session_, moment = std::move(moment),
                 hashes = std::move(hashes), stored, writing = writing_] {
    const auto end = [writing](auto) { writing->under_way = false; };
    storage.journal().post(
        [&storage, session, progress = moment.progress()] {
          storage.sessions().write_progress(session, progress);
        },
        end);  // a failed write does not prevent the next one
    if (stored != Stored::progress) write_state(storage, session, moment, stored, *writing);
    storage.checkpoints().write_hashes(session, hashes);
  });
}

void SessionLog::store_then(SessionMoment moment, SteadyClock::time_point now,
                            std::function<void(Storage&, std::uint64_t)> task) {
  store(std::move(moment), now, true);
  storage_.post([&storage = storage_, session = session_, task = std::move(task)] {
    storage.journal().flush();
    task(storage, session);
  });
}

void SessionLog::write_state(Storage& storage, std::uint64_t session, const SessionMoment& moment,
                             Stored stored, Writing& writing) {
  const auto begin = thread_time();
  const Checkpoint checkpoint{session, moment.position, moment.sequence, moment.fields(),
                              moment.snapshot.to_bytes()};
  if (stored == Stored::recent_state) {
    if (storage.recent_states().write(checkpoint)) storage.count_recent_state();
    writing.checkpoint_cost = CheckpointPace::Seconds(thread_time() - begin).count();
    return;
  }
  const std::size_t bytes = storage.checkpoints().write(checkpoint);
  // Processor time, without waits that do not delay other sessions.
  const CheckpointPace::Seconds cost = thread_time() - begin;
  writing.checkpoint_cost = cost.count();
  storage.count_checkpoint(cost, bytes);
  writing.needs_checkpoint = false;
  bound_log(storage, session, moment, writing);
}

void SessionLog::bound_log(Storage& storage, std::uint64_t session, const SessionMoment& moment,
                           Writing& writing) {
  if (!is_log_full(storage, writing.log_bytes)) return;
  storage.sessions().trim(session, moment.sequence, moment.loaded);
  // Entries that were appended meanwhile are counted twice, until the next trim.
  writing.log_bytes = storage.sessions().log_bytes(session);
  log_info("session s{}: its log was full, and begins at its newest checkpoint now", session);
}

}  // namespace vat
