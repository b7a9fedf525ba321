#include "server/storage/saved_scenes.h"

#include <algorithm>
#include <span>
#include <string_view>

namespace vat {
namespace {

constexpr const char* kWriteScene =
    "INSERT OR REPLACE INTO scenes"
    " (name, title, description, saved_by, address, key, time, bytes, scene)"
    " VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)";

}  // namespace

std::optional<LimitExcess> SavedScenes::find_excess(const SavedScene& scene,
                                                    const SavedSceneLimits& limits) {
  // A replaced one does not count.
  Statement query = main_->database.prepare(
      "SELECT count(*), coalesce(sum(bytes), 0), coalesce(sum(address = ?1), 0),"
      " coalesce(sum(iif(address = ?1, bytes, 0)), 0) FROM scenes WHERE name <> ?2");
  query.bind(0, std::string_view(scene.address)).bind(1, std::string_view(scene.entry.name));
  if (!query.step()) return {};
  const std::size_t bytes = scene.scene.size();
  const LimitExcess limit[] = {{"scenes_per_address", limits.per_address},
                               {"scene_bytes_per_address", limits.bytes_per_address},
                               {"scenes_in_all", limits.in_all},
                               {"scene_bytes_in_all", limits.bytes_in_all}};
  const std::size_t wanted[] = {query.count(2) + 1, query.count(3) + bytes, query.count(0) + 1,
                                query.count(1) + bytes};
  query.reset();
  for (std::size_t i = 0; i < std::size(limit); ++i) {
    if (wanted[i] > limit[i].maximum) return limit[i];
  }
  return {};
}

std::optional<LimitExcess> SavedScenes::write(const SavedScene& scene,
                                              const SavedSceneLimits& limits) {
  const std::lock_guard lock(main_->mutex);
  if (auto excess = find_excess(scene, limits)) return excess;
  const SavedSceneEntry& entry = scene.entry;
  main_->database.prepare(kWriteScene)
      .bind(0, std::string_view(entry.name))
      .bind(1, std::string_view(entry.title))
      .bind(2, std::string_view(entry.description))
      .bind(3, std::string_view(entry.saved_by))
      .bind(4, std::string_view(scene.address))
      .bind(5, std::span<const std::uint8_t>(scene.key))
      .bind(6, entry.time)
      .bind(7, std::uint64_t{scene.scene.size()})
      .bind(8, std::string_view(scene.scene))
      .run();
  return {};
}

std::vector<SavedSceneEntry> SavedScenes::list() {
  const std::lock_guard lock(main_->mutex);
  std::vector<SavedSceneEntry> entries;
  Statement query = main_->database.prepare(
      "SELECT name, title, description, saved_by, time, bytes FROM scenes ORDER BY name");
  while (query.step()) {
    entries.push_back({std::string(query.text(0)), std::string(query.text(1)),
                       std::string(query.text(2)), std::string(query.text(3)), query.real(4),
                       static_cast<std::size_t>(query.count(5))});
  }
  return entries;
}

std::optional<SavedScene> SavedScenes::find(const std::string& name) {
  const std::lock_guard lock(main_->mutex);
  Statement query = main_->database.prepare(
      "SELECT title, description, saved_by, time, bytes, address, key, scene FROM scenes"
      " WHERE name = ?");
  query.bind(0, std::string_view(name));
  if (!query.step()) return {};
  SavedScene scene;
  scene.entry = {name,
                 std::string(query.text(0)),
                 std::string(query.text(1)),
                 std::string(query.text(2)),
                 query.real(3),
                 static_cast<std::size_t>(query.count(4))};
  scene.address = query.text(5);
  const std::span<const std::uint8_t> key = query.bytes(6);
  if (key.size() != scene.key.size()) {
    throw StorageError(StorageError::Kind::corrupt, "a saved scene: its key");
  }
  std::ranges::copy(key, scene.key.begin());
  scene.scene = query.text(7);
  return scene;
}

void SavedScenes::remove(const std::string& name) {
  const std::lock_guard lock(main_->mutex);
  main_->database.prepare("DELETE FROM scenes WHERE name = ?")
      .bind(0, std::string_view(name))
      .run();
}

}  // namespace vat
