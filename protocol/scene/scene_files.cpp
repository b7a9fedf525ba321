#include <algorithm>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "protocol/json/printable.h"
#include "protocol/scene/mesh_file.h"
#include "protocol/scene/scene_json.h"

namespace vat {
namespace {

namespace fs = std::filesystem;

/// Reads a whole file. Fails if it is not a regular file or has more than `max_bytes` bytes.
Result<std::string> read_file(const fs::path& path, const std::string& shown,
                              std::size_t max_bytes) {
  std::error_code failure;
  if (!fs::is_regular_file(path, failure)) {
    return Error{"no_such_file", "", printable(shown) + ": is not a file that can be read"};
  }
  std::ifstream file(path, std::ios::binary);
  std::string text;
  char buffer[1 << 16];
  // The bytes are counted while reading, because the size of a file can change.
  while (file.read(buffer, sizeof buffer) || file.gcount() > 0) {
    text.append(buffer, static_cast<std::size_t>(file.gcount()));
    if (text.size() > max_bytes) {
      return Error{
          "too_large", "",
          printable(shown) + ": at most " + std::to_string(max_bytes) + " bytes are allowed"};
    }
  }
  if (!file.eof()) return Error{"no_such_file", "", printable(shown) + ": cannot be read"};
  return text;
}

bool stays_below(const fs::path& name) {
  return !name.empty() && name.is_relative() &&
         std::none_of(name.begin(), name.end(), [](const fs::path& part) { return part == ".."; });
}

/// Returns the errors with the file name before their messages.
Errors name_file(Errors errors, const std::string& file) {
  for (Error& error : errors) error.message = file + ": " + error.message;
  return errors;
}

}  // namespace

MeshSource meshes_in_folder(std::string folder) {
  return [folder = std::move(folder)](const std::string& name) -> Result<std::string> {
    if (!stays_below(name)) {
      return Error{"bad_file_name", "",
                   printable(name) + ": must be a file below the scene's folder"};
    }
    return read_file(fs::path(folder) / name, name, kMaxMeshBytes);
  };
}

MeshSource meshes_relative_to(std::string folder) {
  return [folder = std::move(folder)](const std::string& name) {
    return read_file(fs::path(folder) / name, name, kMaxMeshBytes);
  };
}

Result<Scene> read_scene_file(const std::string& path) {
  const Result<std::string> text = read_file(path, path, kSceneLimits.bytes);
  if (!text) return text.errors();
  Result<Json> document = parse_json(text.value(), kSceneLimits);
  if (!document) return document.errors();
  Json& scene = document.value();
  if (scene.is_object() && !scene.contains("name")) scene["name"] = fs::path(path).stem().string();
  const fs::path folder = fs::path(path).parent_path();
  return read_scene(scene, meshes_in_folder(folder.empty() ? "." : folder.string()));
}

Result<Catalogue> Catalogue::open(const std::string& folder) {
  std::error_code failure;
  std::vector<fs::path> files;
  for (fs::directory_iterator entry(folder, failure), end; !failure && entry != end;
       entry.increment(failure)) {
    if (entry->path().extension() == ".json") files.push_back(entry->path());
  }
  if (failure) {
    return Error{"no_such_folder", "", "the scenes cannot be listed: " + failure.message()};
  }
  std::sort(files.begin(), files.end());

  Catalogue catalogue;
  Errors errors;
  for (const fs::path& file : files) {
    Result<Scene> scene = read_scene_file(file.string());
    if (!scene) {
      for (Error& error : name_file(scene.errors(), file.string())) errors.push_back(error);
      continue;
    }
    const Scene& read = scene.value();
    catalogue.entries_.push_back({file.stem().string(), read.title, read.description});
    catalogue.scenes_.push_back(std::move(scene).value());
  }
  if (!errors.empty()) return errors;
  return catalogue;
}

const Scene* Catalogue::find(std::string_view name) const {
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    if (entries_[i].name == name) return &scenes_[i];
  }
  return nullptr;
}

}  // namespace vat
