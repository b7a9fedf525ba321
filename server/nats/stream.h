#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "protocol/json/json_reader.h"
#include "server/nats/nats_connection.h"

namespace vat {

/// Message of a stream.
struct StoredMessage {
  std::uint64_t sequence = 0;  ///< number of the message in the stream, from 1
  std::string subject;
  std::map<std::string, std::string> headers;
  std::string data;
};

/// Stream of JetStream, used by its API subjects. A stream stores messages of several subjects and
/// numbers them. Thread-safe. Functions that wait repeat their request for some seconds while no
/// server answers, and throw NatsError.
class Stream {
 public:
  using Appended = std::variant<std::uint64_t, NatsError>;
  using Milliseconds = NatsConnection::Milliseconds;

  struct Settings {
    std::string name;
    std::string subjects;               ///< pattern of the stored subjects
    Milliseconds max_age{0};            ///< age at which messages are removed; 0: never
    std::uint64_t max_per_subject = 0;  ///< messages of one subject; 0: no limit
    std::string republish;  ///< prefix of the core subjects of stored messages; empty: none
  };

  /// Creates the stream if it does not exist. Stores three copies of each message, or one if there
  /// are fewer than three servers. The connection must outlive the stream.
  Stream(NatsConnection& connection, const Settings& settings);

  const std::string& name() const { return name_; }
  /// Appends a message if the last message of its subject has the sequence `expected` (0: the
  /// subject is empty), and calls `done` with the sequence of the message. The error `unreachable`
  /// means that the message may have been stored.
  void append(const std::string& subject, const std::string& data, std::uint64_t expected,
              const NatsConnection::Headers& headers, std::function<void(Appended)> done);
  /// As append(), but waits. Repeats the attempt for some seconds while no server answers.
  std::uint64_t append(const std::string& subject, const std::string& data, std::uint64_t expected,
                       const NatsConnection::Headers& headers = {});
  /// As append(), but requires that the last message of the whole stream has this sequence.
  std::uint64_t append_after(const std::string& subject, const std::string& data,
                             std::uint64_t last_sequence,
                             const NatsConnection::Headers& headers = {});
  /// Appends a message regardless of the subject's last message.
  void append(const std::string& subject, const std::string& data,
              std::function<void(Appended)> done);

  /// Returns the last message of the subject, if any.
  std::optional<StoredMessage> last(const std::string& subject);
  /// Returns the message with this sequence, if it is stored.
  std::optional<StoredMessage> find(std::uint64_t sequence);
  /// Returns the first message of the subject with at least this sequence, if any.
  std::optional<StoredMessage> next(const std::string& subject, std::uint64_t from);
  /// Returns the sequence of the newest message that the stream has had; 0: none.
  std::uint64_t last_sequence();
  /// Returns the name of the server that leads the stream; nothing if there is only one server, or
  /// if none leads it.
  std::optional<std::string> leader();
  /// Lets another server lead the stream.
  void change_leader();
  /// Returns the subjects that have messages.
  std::vector<std::string> subjects(const std::string& pattern);
  /// Removes the subject's messages before this sequence. The subject may contain wildcards.
  void purge(const std::string& subject, std::uint64_t before);
  /// As above, but does not wait. A failure has no effect, because a later call removes the rest.
  void purge_later(const std::string& subject, std::uint64_t before);
  /// Removes all messages of the subject.
  void purge(const std::string& subject);

 private:
  void create(const Settings& settings);
  Json call(const std::string& method, const Json& params);
  std::optional<StoredMessage> get(const Json& params);
  /// Sends a message and waits. Repeats the attempt for some seconds while no server answers. The
  /// stream refuses the message if it has a message of the subject after `expected`.
  std::uint64_t send_until_answered(const std::string& subject,
                                    const NatsConnection::Headers& headers, const std::string& data,
                                    std::uint64_t expected);
  void send(const std::string& subject, const NatsConnection::Headers& headers,
            const std::string& data, std::function<void(Appended)> done);

  NatsConnection& connection_;
  const std::string name_;
};

}  // namespace vat
