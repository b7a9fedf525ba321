#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "server/clients/send_gate.h"
#include "server/cluster/saved/saved_contents.h"
#include "server/cluster/saved/saved_index.h"

namespace vat {

/// Saved data of a cluster: the list and the contents of its entries. An entry of the list has the
/// members `place` and `bytes` of its content. Thread-safe. Functions wait, and throw NatsError.
class SavedStore {
 public:
  /// The arguments must outlive the store. While `gate` is closed, this node has no lease and
  /// stores nothing.
  SavedStore(NatsConnection& connection, const SendGate& gate, const Clock& clock)
      : gate_(gate), index_(connection), contents_(connection, clock) {}

  /// Returns whether the entry must not be written or removed, given all present entries.
  using Refuse = std::function<bool(const SavedEntries&, Json& entry)>;

  /// Stores the content, and then an entry for it, or replaces the entry with this key. Calls
  /// `refuse`, which may change the entry, before each of both. Returns false after a refusal.
  bool write(const std::string& owner, const std::string& key, Json entry, std::string_view content,
             const Refuse& refuse);
  /// Removes an entry and its content. Calls `refuse` first, if the entry exists. Returns false if
  /// there is no such entry, or after a refusal.
  bool remove(const std::string& key, const Refuse& refuse);
  void read(const std::function<void(const SavedEntries&)>& use) { index_.read(use); }
  std::string read_content(const Json& entry) {
    return contents_.read(entry.at("place"), entry.at("bytes"));
  }
  /// Removes all entries whose keys begin with `prefix`, and all contents of the owner.
  void remove_all(const std::string& owner, const std::string& prefix);

 private:
  void require_lease() const;
  /// Removes contents without entries. A failure has no effect, because a later call repeats it.
  void clean(const std::string& owner, const std::string& replaced);

  const SendGate& gate_;
  SavedIndex index_;
  SavedContents contents_;
};

}  // namespace vat
