#include "server/cluster/saved/cluster_states.h"

#include <algorithm>
#include <set>
#include <utility>

#include "server/cluster/saved/saved_errors.h"
#include "server/support/hex.h"

namespace vat {
namespace {

constexpr std::string_view kStates = "state.";

/// Returns the part of the keys that the states of a session have in common.
std::string session_prefix(const std::string& session) {
  return std::string(kStates) + session + '.';
}

std::string state_key(const std::string& session, const std::string& name) {
  return session_prefix(session) + to_hex(name);
}

template <class Use>
void for_each_entry(const SavedEntries& entries, std::string_view prefix, const Use& use) {
  for (auto entry = entries.lower_bound(std::string(prefix));
       entry != entries.end() && entry->first.starts_with(prefix); ++entry) {
    use(entry->first, entry->second);
  }
}

SavedStateUse use_without(const SavedEntries& entries, const std::string& session,
                          const std::string& without) {
  SavedStateUse use;
  const std::string in_session = session_prefix(session);
  for_each_entry(entries, kStates, [&](const std::string& key, const Json& entry) {
    if (key == without) return;
    const std::size_t bytes = entry.at("bytes");
    use.bytes_in_all += bytes;
    if (!key.starts_with(in_session)) return;
    ++use.in_session;
    use.bytes_in_session += bytes;
  });
  return use;
}

Json write_state_entry(const SavedState& state) {
  const SavedStateEntry& entry = state.entry;
  return {{"name", entry.name},           {"saved_by", entry.saved_by},
          {"time", entry.time},           {"tick", entry.tick},
          {"hash", entry.hash},           {"simulation_time", entry.simulation_time},
          {"fields", state.fields.size()}};
}

SavedStateEntry read_state_entry(const Json& entry) {
  return {entry.at("name"), entry.at("saved_by"),        entry.at("time"),
          entry.at("tick"), entry.at("simulation_time"), entry.at("hash"),
          entry.at("bytes")};
}

}  // namespace

std::optional<LimitExcess> ClusterStates::write(const std::string& session, const SavedState& state,
                                                const SavedStateLimits& limits) {
  return with_storage_errors([&] {
    auto excess = try_write(session, state, limits);
    const bool is_of_all = excess && excess->limit == "state_bytes_in_all";
    if (is_of_all && remove_ended_sessions()) excess = try_write(session, state, limits);
    return excess;
  });
}

std::optional<LimitExcess> ClusterStates::try_write(const std::string& session,
                                                    const SavedState& state,
                                                    const SavedStateLimits& limits) {
  const std::string key = state_key(session, state.entry.name);
  std::string content = state.fields;
  content.append(state.state.begin(), state.state.end());
  std::optional<LimitExcess> excess;
  store_.write(session, key, write_state_entry(state), content,
               [&](const SavedEntries& entries, const Json&) {
                 excess = find_excess(use_without(entries, session, key), content.size(), limits);
                 return excess.has_value();
               });
  return excess;
}

std::vector<SavedStateEntry> ClusterStates::list(const std::string& session) {
  return with_storage_errors([&] {
    std::vector<SavedStateEntry> states;
    store_.read([&](const SavedEntries& entries) {
      for_each_entry(entries, session_prefix(session), [&](const std::string&, const Json& entry) {
        states.push_back(read_state_entry(entry));
      });
    });
    return states;
  });
}

std::optional<SavedState> ClusterStates::find(const std::string& session, const std::string& name) {
  return with_storage_errors([&]() -> std::optional<SavedState> {
    std::optional<Json> entry;
    store_.read([&](const SavedEntries& entries) {
      const auto found = entries.find(state_key(session, name));
      if (found != entries.end()) entry = found->second;
    });
    if (!entry) return {};
    SavedState state;
    state.entry = read_state_entry(*entry);
    const std::string content = store_.read_content(*entry);
    const std::size_t fields = entry->at("fields");
    if (fields > content.size()) {
      throw StorageError(StorageError::Kind::corrupt, "a saved state of the cluster: its size");
    }
    state.fields = content.substr(0, fields);
    state.state.assign(content.begin() + static_cast<std::ptrdiff_t>(fields), content.end());
    return state;
  });
}

bool ClusterStates::remove(const std::string& session, const std::string& name) {
  return with_storage_errors([&] {
    return store_.remove(state_key(session, name), [](const auto&, const auto&) { return false; });
  });
}

void ClusterStates::remove_session(const std::string& session) {
  with_storage_errors([&] { store_.remove_all(session, session_prefix(session)); });
}

bool ClusterStates::remove_ended_sessions() {
  std::set<std::string> sessions;
  store_.read([&](const SavedEntries& entries) {
    for_each_entry(entries, kStates, [&](const std::string& key, const Json&) {
      sessions.insert(key.substr(kStates.size(), key.rfind('.') - kStates.size()));
    });
  });
  bool has_removed = false;
  for (const std::string& session : sessions) {
    if (exists_(session)) continue;
    store_.remove_all(session, session_prefix(session));
    has_removed = true;
  }
  return has_removed;
}

}  // namespace vat
