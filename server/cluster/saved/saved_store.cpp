#include "server/cluster/saved/saved_store.h"

#include <optional>
#include <set>
#include <utility>

#include "server/support/log.h"

namespace vat {

void SavedStore::require_lease() const {
  if (gate_.is_open()) return;
  throw NatsError(NatsError::Kind::disconnected, "this node has no lease");
}

bool SavedStore::write(const std::string& owner, const std::string& key, Json entry,
                       std::string_view content, const Refuse& refuse) {
  require_lease();
  bool is_refused = false;
  index_.read([&](const SavedEntries& entries) { is_refused = refuse(entries, entry); });
  if (is_refused) return false;  // before the content, which may be large
  const std::string place = contents_.write(owner, content);
  entry["place"] = place;
  entry["bytes"] = content.size();
  std::string replaced;
  index_.change([&](const SavedEntries& entries) -> std::optional<SavedIndex::Change> {
    require_lease();
    is_refused = refuse(entries, entry);
    if (is_refused) return {};
    const auto before = entries.find(key);
    replaced = before == entries.end() ? "" : before->second.at("place").get<std::string>();
    return SavedIndex::Change{key, entry};
  });
  clean(owner, is_refused ? place : replaced);
  return !is_refused;
}

bool SavedStore::remove(const std::string& key, const Refuse& refuse) {
  require_lease();
  std::optional<Json> removed;
  index_.change([&](const SavedEntries& entries) -> std::optional<SavedIndex::Change> {
    require_lease();
    removed.reset();
    const auto found = entries.find(key);
    if (found == entries.end()) return {};
    Json entry = found->second;
    if (refuse(entries, entry)) return {};
    removed = std::move(entry);
    return SavedIndex::Change{key, {}};
  });
  if (!removed) return false;
  const std::string place = removed->at("place");
  clean(place.substr(0, place.find('.')), place);
  return true;
}

void SavedStore::remove_all(const std::string& owner, const std::string& prefix) {
  for (bool is_left = true; is_left;) {
    index_.change([&](const SavedEntries& entries) -> std::optional<SavedIndex::Change> {
      const auto found = entries.lower_bound(prefix);
      is_left = found != entries.end() && found->first.starts_with(prefix);
      if (!is_left) return {};
      return SavedIndex::Change{found->first, {}};
    });
  }
  contents_.remove_all(owner);
}

void SavedStore::clean(const std::string& owner, const std::string& replaced) {
  try {
    if (!replaced.empty()) contents_.remove(replaced);
    std::set<std::string> used;
    index_.read([&](const SavedEntries& entries) {
      for (const auto& [key, entry] : entries) used.insert(entry.at("place").get<std::string>());
    });
    contents_.remove_unused(owner, used);
  } catch (const NatsError& error) {
    log_warning("unused saved data of the cluster is not removed: {}", error.what());
  }
}

}  // namespace vat
