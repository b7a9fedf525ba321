#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "protocol/json/json_reader.h"
#include "server/nats/bucket.h"

namespace vat {

/// JSON objects by key.
using SavedEntries = std::map<std::string, Json>;

/// List of the saved states and scenes of a cluster: a bucket, and a copy of it that each function
/// brings up to date. A change requires that the copy contains all previous changes. Limits on
/// several entries therefore hold, even if nodes change entries at once. Thread-safe. Functions
/// wait, and throw NatsError.
class SavedIndex {
 public:
  struct Change {
    std::string key;
    std::optional<Json> value;  ///< absent: the entry is removed
  };

  /// The connection must outlive the index. The bucket keeps the marks of removed entries for
  /// `kept_changes` changes.
  explicit SavedIndex(NatsConnection& connection, std::uint64_t kept_changes = 10'000);

  /// Calls `use` with all entries.
  void read(const std::function<void(const SavedEntries&)>& use);
  /// Calls `choose` with all entries, and makes the change that it returns, if any. If another node
  /// makes a change meanwhile, repeats both.
  void change(const std::function<std::optional<Change>(const SavedEntries&)>& choose);

 private:
  void refresh();
  void note(const Bucket::Entry& entry, bool keeps_mark);
  void make(const Change& change);
  void drop_old_marks();

  NatsConnection& connection_;
  const std::uint64_t kept_changes_;
  Bucket bucket_;
  std::mutex mutex_;  // guards the members below, also while a function waits
  SavedEntries entries_;
  std::uint64_t revision_ = 0;                               // of the last change in the copy
  std::deque<std::pair<std::string, std::uint64_t>> marks_;  // to be dropped: keys and revisions
};

}  // namespace vat
