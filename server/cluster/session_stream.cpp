#include "server/cluster/session_stream.h"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <chrono>
#include <utility>

#include "core/support/check.h"
#include "server/cluster/session_locator.h"
#include "server/support/log.h"

namespace vat {
namespace {

constexpr std::chrono::milliseconds kRetryTime(100);
constexpr std::size_t kMaxMessagesWithoutState = 2000;  // a take-over reads them
constexpr std::size_t kMaxRecords = 256;                // in one message

std::uint64_t last_entry_of(const LogRecord& record, std::uint64_t before) {
  const auto* entries = std::get_if<EntriesRecord>(&record);
  return entries == nullptr ? before : entries->entries.back().sequence;
}

}  // namespace

SessionStream::SessionStream(ClusterStreams& streams, const Lease& lease, Clock& clock,
                             boost::asio::any_io_executor executor, Place place,
                             std::function<void()> lost,
                             std::function<void(const std::string&)> renamed)
    : streams_(streams),
      lease_(lease),
      clock_(clock),
      executor_(std::move(executor)),
      session_(place.session),
      epoch_(place.epoch),
      lost_(std::move(lost)),
      renamed_(std::move(renamed)),
      states_(std::make_shared<StateWriter>(streams, session_, epoch_, std::move(place.manifest),
                                            place.manifest_message)),
      retry_timer_(clock.make_timer(executor_)),
      last_messages_(place.last_messages),
      last_entry_(place.last_entry),
      name_(std::move(place.name)),
      settings_(std::move(place.settings)) {
  written_.push_back({last_messages_, last_entry_, 0});
}

bool SessionStream::is_active() const {
  if (!lease_.is_valid()) return false;
  const std::lock_guard lock(mutex_);
  return !ended_;
}

void SessionStream::append(const std::vector<LogEntry>& entries, Done done) {
  VAT_CHECK(!entries.empty());
  add(EntriesRecord{entries}, std::move(done));
}

void SessionStream::refuse(std::uint64_t sequence) {
  add(RefusedRecord{sequence}, {});
}

void SessionStream::reach(std::uint64_t position, Done done) {
  add(ReachedRecord{position}, std::move(done));
}

void SessionStream::write_progress(const SessionProgress& progress, Done done) {
  add(progress, std::move(done));
}

void SessionStream::configure(const std::string& name, const std::string& settings, Done done) {
  boost::asio::post(
      executor_, [self = shared_from_this(), name, settings, done = std::move(done)]() mutable {
        try {
          self->renamed_(name);
        } catch (const NameInUse&) {
          return done(StorageError::Kind::name_used);
        } catch (const NatsError& error) {
          log_warning("session s{}: its name stays: {}", self->session_, error.what());
          return done(StorageError::Kind::unreachable);
        }
        {
          const std::lock_guard lock(self->mutex_);
          self->name_ = name;
          self->settings_ = settings;
        }
        self->add(SettingsRecord{name, settings}, std::move(done));
      });
}

void SessionStream::add(LogRecord record, Done done) {
  bool is_refused = false;
  {
    const std::lock_guard lock(mutex_);
    is_refused = ended_ || !streams_.connection.is_connected();
    if (!is_refused) {
      waiting_.push_back({std::move(record), std::move(done)});
      ++added_;
    }
  }
  if (is_refused) {
    if (done) done(StorageError::Kind::unreachable);
    return;
  }
  send_next();
}

void SessionStream::send_next() {
  {
    const std::lock_guard lock(mutex_);
    if (ended_ || !sending_.empty() || waiting_.empty()) return;
    std::vector<LogRecord> records;
    while (!waiting_.empty() && records.size() < kMaxRecords) {
      records.push_back(waiting_.front().record);
      sending_.push_back(std::move(waiting_.front()));
      waiting_.pop_front();
    }
    sending_parts_ = split_message(write_records(records));
    sending_id_ = std::to_string(epoch_) + "." + std::to_string(++writes_);
  }
  send();
}

void SessionStream::send() {
  std::string bytes;
  NatsConnection::Headers headers{{kEpochHeader, std::to_string(epoch_)}};
  std::uint64_t expected = 0;
  std::size_t stream = 0;
  {
    const std::lock_guard lock(mutex_);
    if (ended_) return;
    const LogPart& part = sending_parts_.front();
    bytes = part.bytes;
    headers.emplace_back(kWriteHeader, sending_id_);
    headers.emplace_back(kPartHeader, part.header);
    stream = stream_;
    expected = last_messages_[stream];
  }
  streams_.logs[stream].append(
      log_subject(session_, stream), bytes, expected, headers,
      [self = shared_from_this()](const Stream::Appended& result) { self->sent(result); });
}

void SessionStream::sent(const Stream::Appended& result) {
  const auto* error = std::get_if<NatsError>(&result);
  if (error == nullptr) return stored(std::get<std::uint64_t>(result));
  switch (error->kind()) {
    case NatsError::Kind::conflict:
      return boost::asio::post(executor_, [self = shared_from_this()] { self->resolve(); });
    case NatsError::Kind::unreachable:
      change_stream();
      return retry();
    case NatsError::Kind::disconnected:
      return retry();
    case NatsError::Kind::refused:
      log_error("session s{}: its log is not written: {}", session_, error->what());
      return fail(StorageError::Kind::failed, false);
  }
}

bool SessionStream::stored_part(std::uint64_t message) {
  const std::lock_guard lock(mutex_);
  if (ended_ || sending_parts_.size() == 1) return false;
  last_messages_[stream_] = message;
  sending_parts_.pop_front();
  sending_id_ = std::to_string(epoch_) + "." + std::to_string(++writes_);
  return true;
}

void SessionStream::stored(std::uint64_t message) {
  if (stored_part(message)) return send();
  std::deque<Item> done;
  {
    const std::lock_guard lock(mutex_);
    if (ended_) return;
    for (const Item& item : sending_) last_entry_ = last_entry_of(item.record, last_entry_);
    last_messages_[stream_] = message;
    records_ += sending_.size();
    written_.push_back({last_messages_, last_entry_, records_});
    ++messages_since_state_;
    done.swap(sending_);
  }
  for (const Item& item : done) {
    if (item.done) item.done({});
  }
  send_next();
}

void SessionStream::retry() {
  const std::lock_guard lock(mutex_);
  if (ended_) return;
  retry_timer_->start(clock_.now() + kRetryTime, [weak = weak_from_this()] {
    if (const auto self = weak.lock()) self->send();
  });
}

void SessionStream::change_stream() {
  const std::lock_guard lock(mutex_);
  stream_ = (stream_ + 1) % kLogStreams;
}

void SessionStream::resolve() {
  std::string id;
  std::size_t stream = 0;
  std::uint64_t from = 0;
  {
    const std::lock_guard lock(mutex_);
    id = sending_id_;
    stream = stream_;
    from = last_messages_[stream] + 1;
  }
  // Messages of the next owner may follow the message.
  std::optional<StoredMessage> next;
  try {
    next = streams_.logs[stream].next(log_subject(session_, stream), from);
  } catch (const NatsError&) {
    change_stream();
    return retry();
  }
  if (next && next->headers[kWriteHeader] == id) return stored(next->sequence);
  if (next && next->headers[kEpochHeader] == std::to_string(epoch_)) {
    // An earlier message, whose acknowledgement came from the other stream.
    {
      const std::lock_guard lock(mutex_);
      last_messages_[stream] = next->sequence;
    }
    return send();
  }
  log_warning("session s{}: another node is its owner", session_);
  fail(StorageError::Kind::unreachable, true);
}

void SessionStream::fail(StorageError::Kind kind, bool is_lost) {
  std::deque<Item> failed;
  {
    const std::lock_guard lock(mutex_);
    if (ended_) return;
    failed.swap(sending_);
    records_ += failed.size();
    if (is_lost) {
      ended_ = true;
      for (Item& item : waiting_) failed.push_back(std::move(item));
      waiting_.clear();
    }
  }
  for (const Item& item : failed) {
    if (item.done) item.done(kind);
  }
  if (is_lost) return lost_();
  send_next();
}

void SessionStream::end() {
  std::deque<Item> failed;
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
    failed.swap(sending_);
    for (Item& item : waiting_) failed.push_back(std::move(item));
    waiting_.clear();
    retry_timer_->cancel();
  }
  for (const Item& item : failed) {
    if (item.done) item.done(StorageError::Kind::unreachable);
  }
}

std::uint64_t SessionStream::mark() const {
  const std::lock_guard lock(mutex_);
  return added_;
}

void SessionStream::write_state(const Checkpoint& state, const LogEntry& loaded, std::uint64_t mark,
                                bool always) {
  PackedState packed{state, loaded, {}, {}, {}};
  {
    const std::lock_guard lock(mutex_);
    if (ended_) return;
    packed.name = name_;
    packed.settings = settings_;
    const auto is_covered = [&](const Written& one) {
      return one.entry <= state.sequence && one.records <= mark;
    };
    while (written_.size() > 1 && is_covered(written_[1])) written_.pop_front();
    packed.covered = written_.front().messages;
    messages_since_state_ = written_.size() - 1;
  }
  states_->write(std::move(packed), always);
}

void SessionStream::flush(Done done) {
  states_->flush(
      [self = shared_from_this(), done = std::move(done)] { self->flush_records(done); });
}

void SessionStream::flush_records(const Done& done) {
  {
    const std::lock_guard lock(mutex_);
    if (!ended_ && !(sending_.empty() && waiting_.empty())) {
      Done& last = (waiting_.empty() ? sending_ : waiting_).back().done;
      last = [before = std::move(last), done](auto failure) {
        if (before) before(failure);
        done({});
      };
      return;
    }
  }
  done({});
}

bool SessionStream::needs_state() const {
  const std::lock_guard lock(mutex_);
  return messages_since_state_ > kMaxMessagesWithoutState;
}

}  // namespace vat
