#include "server/storage/saved/saved_scene_database.h"

#include <algorithm>
#include <span>
#include <string_view>

namespace vat {
namespace {

constexpr const char* kWriteScene =
    "INSERT OR REPLACE INTO scenes"
    " (name, title, description, saved_by, address, key, time, bytes, scene)"
    " VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)";

SceneKey to_scene_key(std::span<const std::uint8_t> bytes) {
  SceneKey key{};
  if (bytes.size() != key.size()) {
    throw StorageError(StorageError::Kind::corrupt, "a saved scene: its key");
  }
  std::ranges::copy(bytes, key.begin());
  return key;
}

}  // namespace

SavedSceneUse SavedSceneDatabase::use_without(const std::string& name, const std::string& address) {
  Statement query = main_->database.prepare(
      "SELECT coalesce(sum(address = ?1), 0), coalesce(sum(iif(address = ?1, bytes, 0)), 0),"
      " count(*), coalesce(sum(bytes), 0) FROM scenes WHERE name <> ?2");
  query.bind(0, std::string_view(address)).bind(1, std::string_view(name));
  if (!query.step()) return {};
  return {static_cast<std::size_t>(query.count(0)), static_cast<std::size_t>(query.count(1)),
          static_cast<std::size_t>(query.count(2)), static_cast<std::size_t>(query.count(3))};
}

std::optional<SavedSceneDatabase::Owner> SavedSceneDatabase::find_owner(const std::string& name) {
  Statement query = main_->database.prepare("SELECT address, key FROM scenes WHERE name = ?");
  query.bind(0, std::string_view(name));
  if (!query.step()) return {};
  return Owner{std::string(query.text(0)), to_scene_key(query.bytes(1))};
}

std::variant<SceneChange, LimitExcess> SavedSceneDatabase::write(SavedScene scene,
                                                                 const SavedSceneLimits& limits,
                                                                 const MayChange& may_change) {
  const std::lock_guard lock(main_->mutex);
  const SavedSceneEntry& entry = scene.entry;
  const auto before = find_owner(entry.name);
  if (before) {
    if (!may_change(before->key)) return SceneChange::refused;
    scene.address = before->address;
    scene.key = before->key;
  }
  const SavedSceneUse use = use_without(entry.name, scene.address);
  if (const auto excess = find_excess(use, scene.scene.size(), limits)) return *excess;
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
  return before ? SceneChange::replaced : SceneChange::added;
}

std::vector<SavedSceneEntry> SavedSceneDatabase::list() {
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

std::optional<SavedScene> SavedSceneDatabase::find(const std::string& name) {
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
  scene.key = to_scene_key(query.bytes(6));
  scene.scene = query.text(7);
  return scene;
}

SceneChange SavedSceneDatabase::remove(const std::string& name, const MayChange& may_change) {
  const std::lock_guard lock(main_->mutex);
  const auto owner = find_owner(name);
  if (!owner) return SceneChange::absent;
  if (!may_change(owner->key)) return SceneChange::refused;
  main_->database.prepare("DELETE FROM scenes WHERE name = ?")
      .bind(0, std::string_view(name))
      .run();
  return SceneChange::removed;
}

}  // namespace vat
