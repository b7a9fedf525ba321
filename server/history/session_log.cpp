#include "server/history/session_log.h"

#include <algorithm>
#include <utility>

#include "core/support/check.h"
#include "server/storage/sqlite/compression.h"
#include "server/support/log.h"
#include "server/support/stage_clock.h"

namespace vat {
namespace {

constexpr auto kProgressInterval = std::chrono::seconds(1);
// A take-over begins after the wait for a lease, so it may repeat less than a restart.
constexpr int kReplicaPart = 4;
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

SessionLog::SessionLog(Storage& storage, std::uint64_t session, const Place& place,
                       std::shared_ptr<SessionReplica> replica)
    : storage_(storage),
      session_(session),
      replica_(std::move(replica)),
      last_(place.last),
      pace_(storage.settings().checkpoint_after / (replica_ == nullptr ? 1 : kReplicaPart)),
      stored_position_(place.position),
      stored_last_(place.last) {
  storage_.open_log();
  pace_.add_work(place.work);
  writing_->needs_checkpoint = place.needs_checkpoint;
  writing_->log_bytes = place.log_bytes;
}

void SessionLog::number(std::span<LogEntry> entries) const {
  for (std::size_t i = 0; i < entries.size(); ++i) entries[i].sequence = last_ + 1 + i;
}

SessionLog::Write SessionLog::local(Journal::Write write) const {
  return [&storage = storage_, write = std::move(write)](Journal::Done done) {
    storage.journal().post(write, std::move(done));
  };
}

SessionLog::Write SessionLog::replicated(
    Write write, std::function<void(SessionReplica&, Journal::Done)> replicate) const {
  if (replica_ == nullptr) return write;
  return [replica = replica_, session = session_, write = std::move(write),
          replicate = std::move(replicate)](Journal::Done done) {
    replicate(*replica, [session, write, done = std::move(done)](auto failure) {
      if (failure) {
        if (done) done(failure);
        return;
      }
      write([session, done](auto local_failure) {
        if (local_failure) log_error("session s{}: its working copy is incomplete", session);
        if (done) done({});
      });
    });
  };
}

void SessionLog::append(std::vector<LogEntry> entries, Journal::Done done) {
  VAT_CHECK(!entries.empty() && entries.front().sequence == last_ + 1 && done != nullptr);
  writing_->log_bytes += bytes_of(entries);
  const auto shared = std::make_shared<const std::vector<LogEntry>>(std::move(entries));
  Write write = replicated(local([&storage = storage_, session = session_, shared] {
                             storage.sessions().append(session, *shared);
                           }),
                           [shared](SessionReplica& replica, Journal::Done stored) {
                             replica.append(*shared, std::move(stored));
                           });
  if (!writing_->needs_checkpoint) return write(std::move(done));
  // Behind the checkpoint, which store() has posted to the same thread.
  storage_.post([writing = writing_, write = std::move(write), done = std::move(done)]() mutable {
    if (writing->needs_checkpoint) return done(StorageError::Kind::failed);
    write(std::move(done));
  });
}

void SessionLog::refuse(std::uint64_t sequence) {
  VAT_CHECK(sequence > 0 && sequence <= last_);
  // Without the mark, a recovery refuses the entry as well, unless the server's limits have
  // changed.
  if (replica_ != nullptr) replica_->refuse(sequence);
  storage_.journal().post([&storage = storage_, session = session_, sequence] {
    storage.sessions().refuse(session, sequence);
  });
}

void SessionLog::reach(std::uint64_t position, Journal::Done done) {
  replicated(local([&storage = storage_, session = session_, position] {
               storage.sessions().reach(session, position);
             }),
             [position](SessionReplica& replica, Journal::Done stored) {
               replica.reach(position, std::move(stored));
             })(std::move(done));
}

void SessionLog::configure(std::string name, std::string settings, Journal::Done done) {
  replicated(local([&storage = storage_, session = session_, name, settings] {
               storage.sessions().configure(session, name, settings);
             }),
             [name, settings](SessionReplica& replica, Journal::Done stored) {
               replica.configure(name, settings, std::move(stored));
             })(std::move(done));
}

void SessionLog::store_people(SessionMoment moment, Journal::Done done) {
  if (replica_ == nullptr) return done({});
  // The hash of the state may take long.
  storage_.post([replica = replica_, moment = std::move(moment), done = std::move(done)] {
    replica->write_progress(moment.progress(), done);
  });
}

SessionLog::Stored SessionLog::due() const {
  if (writing_->needs_checkpoint) return Stored::checkpoint;
  const CheckpointPace::Seconds cost(writing_->checkpoint_cost);
  const bool is_long = replica_ != nullptr && replica_->needs_state();
  if (!is_long && !pace_.is_due(cost, storage_.open_logs())) return Stored::progress;
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
  const std::uint64_t mark = replica_ == nullptr ? 0 : replica_->mark();
  storage_.post([&storage = storage_, session = session_, moment = std::move(moment),
                 hashes = std::move(hashes), stored, writing = writing_, replica = replica_, mark,
                 always] {
    const auto end = [writing](auto) { writing->under_way = false; };
    const SessionProgress progress = moment.progress();
    if (replica != nullptr) replica->write_progress(progress, {});
    storage.journal().post(
        [&storage, session, progress] { storage.sessions().write_progress(session, progress); },
        end);  // a failed write does not prevent the next one
    if (stored != Stored::progress) {
      const Checkpoint state = write_state(storage, session, moment, stored, *writing);
      if (replica != nullptr) write_replica(storage, moment, state, *replica, mark, always);
    }
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

void SessionLog::store_all(SessionMoment moment, SteadyClock::time_point now,
                           std::function<void()> done) {
  store(std::move(moment), now, true);
  storage_.post([replica = replica_, done = std::move(done)] {
    if (replica == nullptr) return done();
    replica->flush([done](auto) { done(); });
  });
}

Checkpoint SessionLog::write_state(Storage& storage, std::uint64_t session,
                                   const SessionMoment& moment, Stored stored, Writing& writing) {
  const auto begin = thread_time();
  Checkpoint checkpoint{session, moment.position, moment.sequence, moment.fields(),
                        moment.snapshot.to_bytes()};
  if (stored == Stored::recent_state) {
    if (storage.recent_states().write(checkpoint)) storage.count_recent_state();
    writing.checkpoint_cost = CheckpointPace::Seconds(thread_time() - begin).count();
    return checkpoint;
  }
  const std::size_t bytes = storage.checkpoints().write(checkpoint);
  // Processor time, without waits that do not delay other sessions.
  const CheckpointPace::Seconds cost = thread_time() - begin;
  writing.checkpoint_cost = cost.count();
  storage.count_checkpoint(cost, bytes);
  writing.needs_checkpoint = false;
  bound_log(storage, session, moment, writing);
  return checkpoint;
}

void SessionLog::write_replica(Storage& storage, const SessionMoment& moment, Checkpoint state,
                               SessionReplica& replica, std::uint64_t mark, bool always) {
  const auto loaded = storage.sessions().find(state.session, moment.loaded);
  if (!loaded) {
    log_error("session s{}: the log lacks its scene", state.session);
    return;
  }
  state.state = compress(state.state);
  replica.write_state(state, *loaded, mark, always);
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
