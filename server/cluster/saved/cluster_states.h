#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/cluster/saved/saved_store.h"
#include "server/storage/saved/saved_states.h"

namespace vat {

/// Saved states of the sessions of a cluster. Each node has the same list.
class ClusterStates final : public SavedStates {
 public:
  /// Returns whether the cluster has the session. Waits. Throws NatsError.
  using Exists = std::function<bool(const std::string& session)>;

  /// `store` must outlive the states.
  ClusterStates(SavedStore& store, Exists exists) : store_(store), exists_(std::move(exists)) {}

  std::optional<LimitExcess> write(const std::string& session, const SavedState& state,
                                   const SavedStateLimits& limits) override;
  std::vector<SavedStateEntry> list(const std::string& session) override;
  std::optional<SavedState> find(const std::string& session, const std::string& name) override;
  bool remove(const std::string& session, const std::string& name) override;
  /// Removes the states of a session.
  void remove_session(const std::string& session);

 private:
  std::optional<LimitExcess> try_write(const std::string& session, const SavedState& state,
                                       const SavedStateLimits& limits);
  /// Removes the states of sessions that ended while their node could not remove the states.
  /// Returns whether there were any.
  bool remove_ended_sessions();

  SavedStore& store_;
  const Exists exists_;
};

}  // namespace vat
