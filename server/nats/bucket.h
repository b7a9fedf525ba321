#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/nats/stream.h"

namespace vat {

/// Key-value bucket of JetStream. Each change of a value has a revision, and a write can require
/// the revision that it replaces. Other tools for NATS can read it. Thread-safe. Functions that
/// wait throw NatsError.
class Bucket {
 public:
  struct Entry {
    std::string key;
    std::string value;
    std::uint64_t revision = 0;
    bool is_removed = false;
  };
  /// Revision of a key that has no value.
  static constexpr std::uint64_t kNone = 0;

  /// Creates the bucket if it does not exist. A value is removed `life` after its last
  /// renewal; 0: never. The connection must outlive the bucket.
  Bucket(NatsConnection& connection, const std::string& name, std::chrono::milliseconds life);

  /// Returns the value, if the key has one.
  std::optional<Entry> get(const std::string& key);
  /// Returns the values of all keys.
  std::vector<Entry> all();
  /// Returns the revision of the newest change; 0: there was none.
  std::uint64_t last_revision() { return stream_.last_sequence(); }
  /// Returns the last change of each key that has changed after the revision, in ascending order.
  std::vector<Entry> changes_since(std::uint64_t revision);
  /// Replaces the value if the key has the revision, and returns the new revision. Throws NatsError
  /// (kind `conflict`) if the key has another revision.
  std::uint64_t put(const std::string& key, const std::string& value, std::uint64_t revision);
  /// Writes a value if the key has none. Throws NatsError (kind `conflict`) otherwise.
  std::uint64_t create(const std::string& key, const std::string& value);
  /// As put(), but calls `done` with the new revision.
  void put(const std::string& key, const std::string& value, std::uint64_t revision,
           std::function<void(Stream::Appended)> done);
  /// As above, but replaces any value.
  void put(const std::string& key, const std::string& value,
           std::function<void(Stream::Appended)> done);
  /// Removes the value if the key has the revision. NATS then stores a mark of the removal. Returns
  /// the revision of this mark.
  std::uint64_t remove(const std::string& key, std::uint64_t revision);
  /// Writes a value if no key of the bucket has changed after the revision. Returns the new
  /// revision. Throws NatsError (kind `conflict`) if a key has changed.
  std::uint64_t put_after(const std::string& key, const std::string& value,
                          std::uint64_t last_revision);
  /// As remove(), if no key of the bucket has changed after the revision. Throws NatsError (kind
  /// `conflict`) if a key has changed.
  std::uint64_t remove_after(const std::string& key, std::uint64_t last_revision);
  /// Removes the mark of a removal, unless the key has a newer revision. Does not wait. A failure
  /// has no effect.
  void drop_mark(const std::string& key, std::uint64_t revision);
  /// Removes the values of all keys that match the pattern, and their revisions.
  void purge(const std::string& pattern);

  Stream& stream() { return stream_; }

  /// Calls `handler` for each change after the call. Changes during a loss of the connection are
  /// missing; read all() after it.
  std::unique_ptr<NatsConnection::Subscription> watch(std::function<void(const Entry&)> handler);

 private:
  std::string subject(const std::string& key) const { return prefix_ + key; }

  NatsConnection& connection_;
  const std::string prefix_;
  const std::string watched_;  ///< prefix of the republished changes
  Stream stream_;
};

}  // namespace vat
