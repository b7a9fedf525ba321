#include "server/cluster/saved/cluster_scenes.h"

#include <algorithm>
#include <utility>

#include "server/cluster/saved/saved_errors.h"
#include "server/support/base64.h"
#include "server/support/hex.h"

namespace vat {
namespace {

constexpr const char* kOwner = "scenes";  // of the contents
constexpr std::string_view kScenes = "scene.";

std::string scene_key(const std::string& name) {
  return std::string(kScenes) + to_hex(name);
}

bool is_scene(const std::string& key) {
  return key.starts_with(kScenes);
}

SavedSceneUse scene_use_without(const SavedEntries& entries, const std::string& address,
                                const std::string& without) {
  SavedSceneUse use;
  for (const auto& [key, entry] : entries) {
    if (!is_scene(key) || key == without) continue;
    const std::size_t bytes = entry.at("bytes");
    ++use.in_all;
    use.bytes_in_all += bytes;
    if (entry.at("address") != address) continue;
    ++use.of_address;
    use.bytes_of_address += bytes;
  }
  return use;
}

SceneKey read_scene_key(const Json& entry) {
  const auto bytes = from_base64(entry.at("key").get_ref<const std::string&>());
  SceneKey key{};
  if (!bytes || bytes->size() != key.size()) {
    throw StorageError(StorageError::Kind::corrupt, "a saved scene of the cluster: its key");
  }
  std::ranges::copy(*bytes, key.begin());
  return key;
}

Json write_scene_entry(const SavedScene& scene) {
  const SavedSceneEntry& entry = scene.entry;
  return {{"name", entry.name},         {"title", entry.title},
          {"time", entry.time},         {"description", entry.description},
          {"saved_by", entry.saved_by}, {"address", scene.address},
          {"key", to_base64(scene.key)}};
}

SavedSceneEntry read_scene_entry(const Json& entry) {
  return {entry.at("name"),     entry.at("title"), entry.at("description"),
          entry.at("saved_by"), entry.at("time"),  entry.at("bytes")};
}

}  // namespace

std::variant<SceneChange, LimitExcess> ClusterScenes::write(SavedScene scene,
                                                            const SavedSceneLimits& limits,
                                                            const MayChange& may_change) {
  using Written = std::variant<SceneChange, LimitExcess>;
  return with_storage_errors([&]() -> Written {
    const std::string key = scene_key(scene.entry.name);
    const Json whole = write_scene_entry(scene);
    Written written = SceneChange::added;
    const auto refuse = [&](const SavedEntries& entries, Json& entry) {
      entry.update(whole);
      written = SceneChange::added;
      if (const auto before = entries.find(key); before != entries.end()) {
        const bool is_permitted = may_change(read_scene_key(before->second));
        written = is_permitted ? SceneChange::replaced : SceneChange::refused;
        if (!is_permitted) return true;
        for (const char* member : {"address", "key"}) entry[member] = before->second.at(member);
      }
      const auto use = scene_use_without(entries, entry.at("address"), key);
      const auto excess = find_excess(use, scene.scene.size(), limits);
      if (excess) written = *excess;
      return excess.has_value();
    };
    store_.write(kOwner, key, whole, scene.scene, refuse);
    return written;
  });
}

std::vector<SavedSceneEntry> ClusterScenes::list() {
  return with_storage_errors([&] {
    std::vector<SavedSceneEntry> scenes;
    store_.read([&](const SavedEntries& entries) {
      for (const auto& [key, entry] : entries) {
        if (is_scene(key)) scenes.push_back(read_scene_entry(entry));
      }
    });
    return scenes;
  });
}

std::optional<SavedScene> ClusterScenes::find(const std::string& name) {
  return with_storage_errors([&]() -> std::optional<SavedScene> {
    std::optional<Json> entry;
    store_.read([&](const SavedEntries& entries) {
      const auto found = entries.find(scene_key(name));
      if (found != entries.end()) entry = found->second;
    });
    if (!entry) return {};
    return SavedScene{read_scene_entry(*entry), entry->at("address"), read_scene_key(*entry),
                      store_.read_content(*entry)};
  });
}

SceneChange ClusterScenes::remove(const std::string& name, const MayChange& may_change) {
  return with_storage_errors([&] {
    SceneChange change = SceneChange::absent;
    const bool is_removed =
        store_.remove(scene_key(name), [&](const SavedEntries&, const Json& entry) {
          const bool is_permitted = may_change(read_scene_key(entry));
          if (!is_permitted) change = SceneChange::refused;
          return !is_permitted;
        });
    return is_removed ? SceneChange::removed : change;
  });
}

}  // namespace vat
