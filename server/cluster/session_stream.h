#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "server/cluster/cluster_streams.h"
#include "server/cluster/lease.h"
#include "server/cluster/log_records.h"
#include "server/cluster/state_writer.h"
#include "server/history/session_replica.h"

namespace vat {

/// Replica of a session in the streams of a cluster, written by the owner of the session. At most
/// one message of a session is being stored. Records that arrive meanwhile share the next message.
/// A message requires that the stream's last message of the session is one of this node. If another
/// node has appended one, this node is no longer the owner. If a stream does not answer, the
/// message goes to the other one, with the same identifier. Create it with std::make_shared.
class SessionStream final : public SessionReplica,
                            public std::enable_shared_from_this<SessionStream> {
 public:
  struct Place {
    std::uint64_t session = 0;
    std::uint64_t epoch = 0;
    LogEnds last_messages{};       ///< last messages of the log
    std::uint64_t last_entry = 0;  ///< sequence of the log's last entry
    std::string name;
    std::string settings;
    StateManifest manifest;
    std::uint64_t manifest_message = 0;  ///< number of the manifest's message; 0: none
  };
  /// `executor` runs work that waits. `lost` is called once if another node has become the owner.
  /// `renamed` is called on `executor` before a new name is stored, and throws NameInUse or another
  /// NatsError. The other arguments must outlive the stream.
  SessionStream(ClusterStreams& streams, const Lease& lease, Clock& clock,
                boost::asio::any_io_executor executor, Place place, std::function<void()> lost,
                std::function<void(const std::string&)> renamed);

  std::uint64_t epoch() const { return epoch_; }
  void append(const std::vector<LogEntry>& entries, Done done) override;
  void refuse(std::uint64_t sequence) override;
  void reach(std::uint64_t position, Done done) override;
  void configure(const std::string& name, const std::string& settings, Done done) override;
  void write_progress(const SessionProgress& progress, Done done) override;
  std::uint64_t mark() const override;
  void write_state(const Checkpoint& state, const LogEntry& loaded, std::uint64_t mark,
                   bool always) override;
  void flush(Done done) override;
  bool needs_state() const override;
  bool is_active() const override;
  /// Fails all waiting records, and refuses later ones.
  void end();

 private:
  struct Item {
    LogRecord record;
    Done done;
  };
  /// Last messages after a message, the last entry up to its end, and the count of records up to
  /// it.
  struct Written {
    LogEnds messages{};
    std::uint64_t entry = 0;
    std::uint64_t records = 0;
  };
  /// Adds a record, or fails it at once if NATS cannot be reached.
  void add(LogRecord record, Done done);
  /// Sends the waiting records, unless a message is being stored.
  void send_next();
  void send();
  void sent(const Stream::Appended& result);
  void stored(std::uint64_t message);
  /// Notes that a part of the message is stored. Returns false if it was the last one.
  bool stored_part(std::uint64_t message);
  /// Continues with the other stream.
  void change_stream();
  /// Finds out whether the message was stored, although its acknowledgement is missing. Waits.
  void resolve();
  void retry();
  /// Calls `done` after all waiting records are stored or have failed.
  void flush_records(const Done& done);
  void fail(StorageError::Kind kind, bool is_lost);

  ClusterStreams& streams_;
  const Lease& lease_;
  Clock& clock_;
  const boost::asio::any_io_executor executor_;
  const std::uint64_t session_;
  const std::uint64_t epoch_;
  const std::function<void()> lost_;
  const std::function<void(const std::string&)> renamed_;
  const std::shared_ptr<StateWriter> states_;
  const std::unique_ptr<Timer> retry_timer_;

  mutable std::mutex mutex_;  // guards the members below
  std::deque<Item> waiting_;
  std::deque<Item> sending_;           // records of the message that is being stored
  std::deque<LogPart> sending_parts_;  // the first one is being stored
  std::string sending_id_;
  std::size_t stream_ = 0;  // index of the stream that is written
  LogEnds last_messages_;
  std::uint64_t last_entry_;
  // The last message that the newest state covers, and the later ones.
  std::deque<Written> written_;
  std::string name_;
  std::string settings_;
  std::uint64_t writes_ = 0;
  std::uint64_t added_ = 0;    // records
  std::uint64_t records_ = 0;  // records that are stored or have failed
  std::size_t messages_since_state_ = 0;
  bool ended_ = false;
};

}  // namespace vat
