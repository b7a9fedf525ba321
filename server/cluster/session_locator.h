#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "server/nats/bucket.h"

namespace vat {

/// Session of a cluster, and the node that owns it.
struct LocatedSession {
  std::uint64_t number = 0;
  std::string name;
  std::string owner;        ///< name of the node; empty: released
  std::string successor;    ///< node that should take a released session; empty: any
  std::uint64_t epoch = 0;  ///< increases with each change of the owner
  std::string instruction_set;
  double created = 0;          ///< [s since 1970]
  std::uint64_t revision = 0;  ///< see Bucket
};

/// Failure of a creation or renaming: another session of the cluster has the name.
class NameInUse : public NatsError {
 public:
  explicit NameInUse(const std::string& name)
      : NatsError(Kind::conflict, name + ": the name is in use") {}
};

/// Directory of a cluster's sessions: a bucket, and a copy of it that follows the changes. A change
/// of an entry requires the revision of the entry. Thread-safe. Functions that wait throw
/// NatsError; its kind is `conflict` if another node has changed the entry.
class SessionLocator {
 public:
  /// The connection must outlive the locator. The bucket keeps the marks of removed sessions for
  /// `kept_changes` changes.
  explicit SessionLocator(NatsConnection& connection, std::uint64_t kept_changes = 10'000);

  /// Calls `changed` after each change of the copy, on a thread of the connection or of the caller
  /// of refresh().
  void watch(std::function<void(const LocatedSession&)> changed);
  /// Reads the entries at the first call, and afterwards the changes that watch() has missed, for
  /// example during a loss of the connection. Drops old marks. Waits.
  void refresh();

  /// Returns a number that no session of the cluster has had. Waits.
  std::uint64_t next_number();
  /// Adds a session. A name that is not empty must be unique. Waits. Throws NameInUse.
  LocatedSession create(LocatedSession session);
  /// Makes `node` the owner, with the next epoch. Waits.
  LocatedSession take(const LocatedSession& session, const std::string& node);
  /// Writes the entry without a change, which fails if another node has changed it. Waits.
  LocatedSession renew(const LocatedSession& session);
  /// Removes the owner, and names the node that should take the session. Waits.
  LocatedSession release(const LocatedSession& session, const std::string& successor);
  /// Changes the name, which must be unique. Waits. Throws NameInUse.
  LocatedSession rename(const LocatedSession& session, const std::string& name);
  /// Removes the session. Waits.
  void remove(const LocatedSession& session);
  /// Reads the entry from the bucket. Waits.
  std::optional<LocatedSession> read(std::uint64_t number);

  /// Returns the copy of an entry.
  std::optional<LocatedSession> find(std::uint64_t number) const;
  /// Returns the copies of all entries, in ascending order of their numbers.
  std::vector<LocatedSession> all() const;
  /// Returns the nodes that own sessions, in alphabetical order; "" owns the released ones.
  std::vector<std::string> owners() const;
  /// Returns the copies of the entries of an owner, in ascending order of their numbers.
  std::vector<LocatedSession> sessions_of(const std::string& owner) const;

 private:
  LocatedSession put(LocatedSession session);
  void take_name(const std::string& name, std::uint64_t number);
  /// Removes the session and throws NatsError if the name belongs to another session.
  void check_name(const LocatedSession& session);
  void free_name(const std::string& name, std::uint64_t number);
  void remove_key(const std::string& key, std::uint64_t revision);
  void drop_old_marks(std::uint64_t last_revision);
  void follow(const Bucket::Entry& entry);
  void read_all(std::uint64_t last_revision);
  /// Notes an entry unless a later one is known, and calls the function of watch().
  void note(const LocatedSession& session, bool is_removed);
  void erase(std::map<std::uint64_t, LocatedSession>::iterator session);

  Bucket bucket_;
  const std::uint64_t kept_changes_;
  mutable std::mutex mutex_;  // guards the members up to `complete_to_`
  std::map<std::uint64_t, LocatedSession> sessions_;
  std::map<std::string, std::set<std::uint64_t>> by_owner_;  // numbers of `sessions_`
  std::map<std::uint64_t, std::uint64_t> removed_;  // revisions of removals by session number
  std::deque<std::pair<std::string, std::uint64_t>> marks_;  // to be dropped: keys and revisions
  std::uint64_t complete_to_ = 0;  // the copy contains all changes up to this revision
  std::function<void(const LocatedSession&)> changed_;
  std::unique_ptr<NatsConnection::Subscription> watch_;
};

}  // namespace vat
