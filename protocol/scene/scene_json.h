#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/scene.h"
#include "core/support/result.h"
#include "protocol/json/json_reader.h"

namespace vat {

/// Function that returns the text of a scene's `.obj` file, or an error. The server's function
/// reads only files of its catalogue, so that clients cannot read other files.
using MeshSource = std::function<Result<std::string>(const std::string& name)>;

/// Returns a source that reads files below `folder`. The source rejects absolute names and names
/// with "..".
MeshSource meshes_in_folder(std::string folder);
/// Returns a source that reads any file, relative to `folder`. For files that the program's user
/// names.
MeshSource meshes_relative_to(std::string folder);

/// Limits of the JSON text of a scene.
inline constexpr JsonLimits kSceneLimits{4 * 1024 * 1024, 16, 1'000'000};

/// Returns a scene. Returns all errors of the document and of the scene's values (find_errors()).
/// If the document has errors, find_errors() checks only completely read parts.
Result<Scene> read_scene(const Json& document, const MeshSource& meshes);
Result<Scene> read_scene_text(std::string_view text, const MeshSource& meshes);
/// Returns the scene of a file, with mesh files of the same folder. A scene without a name gets the
/// file name without its extension.
Result<Scene> read_scene_file(const std::string& path);

/// Return one body, interface or material in the format of a scene file. Check the document but not
/// its consistency with a scene. Paths of errors begin with `path`.
Result<BodyDescription> read_body(const Json& document, const std::string& path,
                                  const MeshSource& meshes);
Result<InterfaceDescription> read_interface(const Json& document, const std::string& path);
Result<Material> read_material(const Json& document, const std::string& path);

/// Returns JSON from which read_scene() creates a bitwise equal scene. Meshes are inline, with
/// vertices and triangles.
Json write_scene(const Scene& scene);
/// Returns a shape in the format of a scene file.
Json write_shape(const Shape& shape);

/// Entry of the catalogue of scenes. `name` is the file name without its extension.
struct CatalogueEntry {
  std::string name;
  std::string title;
  std::string description;
};
/// Catalogue of all scene files (`*.json`) in a folder.
class Catalogue {
 public:
  /// Returns an error if the folder cannot be read or a file is not a valid scene.
  static Result<Catalogue> open(const std::string& folder);
  const std::vector<CatalogueEntry>& entries() const { return entries_; }
  /// Returns the scene, or null if the catalogue has no scene with this name.
  const Scene* find(std::string_view name) const;

 private:
  std::vector<CatalogueEntry> entries_;
  std::vector<Scene> scenes_;
};

}  // namespace vat
