#include "server/cli/common/scene_argument.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <system_error>

#include "core/support/nearest_name.h"
#include "protocol/scene/scene_json.h"

namespace vat {

namespace fs = std::filesystem;

namespace {

bool names_a_file(const std::string& argument) {
  return argument.find('/') != std::string::npos || fs::path(argument).extension() == ".json";
}

Result<Scene> load_file(const fs::path& path) {
  std::error_code failed;
  if (!fs::exists(path, failed)) return Error{"no_such_file", path.string(), "does not exist"};
  if (!fs::is_regular_file(path, failed)) {
    return Error{"no_such_file", path.string(), "is not a file"};
  }
  return read_scene_file(path.string());
}

Error unknown_scene(const std::string& name, const std::vector<std::string>& known) {
  std::string message = "is not in the catalogue, which has";
  for (const std::string& other : known) message += ' ' + other;
  if (known.empty()) message += " no scenes";
  NearestName nearest(name);
  nearest.consider_all(known, std::identity());
  return with_suggestion({"unknown_scene", name, message}, nearest.suggestion());
}

Result<Scene> load_normal(const std::string& argument, const std::string& scenes_folder) {
  if (names_a_file(argument)) return load_file(argument);
  const Result<std::vector<std::string>> names = catalogue_names(scenes_folder);
  if (!names) return names.errors();
  if (!std::ranges::binary_search(names.value(), argument)) {
    return unknown_scene(argument, names.value());
  }
  return load_file(scene_file(argument, scenes_folder));
}

}  // namespace

std::string scene_file(const std::string& argument, const std::string& scenes_folder) {
  if (names_a_file(argument)) return argument;
  return (fs::path(scenes_folder) / (argument + ".json")).string();
}

Result<Scene> load_scene(const std::string& argument, const std::string& scenes_folder,
                         Level level) {
  Result<Scene> scene = load_normal(argument, scenes_folder);
  return scene ? at_level(std::move(scene).value(), level) : std::move(scene);
}

Result<std::vector<std::string>> catalogue_names(const std::string& scenes_folder) {
  std::error_code failed;
  std::vector<std::string> names;
  for (fs::directory_iterator entry(scenes_folder, failed), end; !failed && entry != end;
       entry.increment(failed)) {
    if (entry->path().extension() == ".json") names.push_back(entry->path().stem().string());
  }
  if (failed) {
    return Error{"io_error", scenes_folder, "the scenes cannot be listed: " + failed.message()};
  }
  std::ranges::sort(names);
  return names;
}

}  // namespace vat
