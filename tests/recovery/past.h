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

/// What is stored of a session whose server has been killed.
struct StoredPast {
  std::string name;
  std::vector<LogEntry> log;
  std::uint64_t position = 0;  ///< where it will come back
};

/// By the sessions' ids.
std::map<std::string, StoredPast> read_past(const std::string& data_folder);

/// All hashes that a session had at each position, from its first entry to its last position, by
/// carrying out its whole log again, without a checkpoint.
std::map<std::uint64_t, std::set<std::string>> hashes_of(const StoredPast& past,
                                                         const Catalogue& catalogue);

}  // namespace vat::test
