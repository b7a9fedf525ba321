#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "protocol/scene/scene_json.h"
#include "server/storage/log_entry.h"
#include "server/storage/session_store.h"

namespace vat::test {

/// The stored history of a session whose server was killed.
struct StoredPast {
  std::string name;
  std::vector<LogEntry> log;
  std::uint64_t position = 0;  ///< position after recovery
};

/// Returns the stored histories by session id.
std::map<std::string, StoredPast> read_past(const std::string& data_folder);

/// Returns all hashes of a session at each position, from its first entry to its last position.
/// Executes its complete log without checkpoints.
std::map<std::uint64_t, std::set<std::string>> hashes_of(const StoredPast& past,
                                                         const Catalogue& catalogue);

}  // namespace vat::test
