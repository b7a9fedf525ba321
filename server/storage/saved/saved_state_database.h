#pragma once

#include <mutex>
#include <string>
#include <vector>

#include "server/storage/saved/saved_states.h"
#include "server/storage/sqlite/database.h"
#include "server/storage/sqlite/schema.h"

namespace vat {

/// Saved states in a separate database of a data folder, so that large states do not delay
/// commands.
class SavedStateDatabase final : public SavedStates {
 public:
  /// `path` may be MainDatabase::kInMemory.
  explicit SavedStateDatabase(const std::string& path, Durability durability = Durability::process);

  std::optional<LimitExcess> write(const std::string& session, const SavedState& state,
                                   const SavedStateLimits& limits) override;
  std::vector<SavedStateEntry> list(const std::string& session) override;
  std::optional<SavedState> find(const std::string& session, const std::string& name) override;
  bool remove(const std::string& session, const std::string& name) override;
  /// Removes the states of a session, and frees their space on the disk.
  void remove_session(const std::string& session);
  /// Removes the states of all other sessions.
  void keep_only(const std::vector<std::string>& sessions);

  std::size_t move_log(bool wait);

 private:
  /// Returns the use by all states except the one with this name.
  SavedStateUse use_without(const std::string& session, const std::string& name);

  std::mutex mutex_;
  Database database_;
};

/// Returns the schema of the store's database.
Schema state_schema();

}  // namespace vat
