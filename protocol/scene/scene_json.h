#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/scene.h"
#include "core/support/result.h"
#include "protocol/json/json_reader.h"

namespace vat {

/// Returns the text of the `.obj` file of a scene, or an error. The server's source reads its
/// catalogue only, so that clients cannot read other files.
using MeshSource = std::function<Result<std::string>(const std::string& name)>;

/// Returns a source that reads files below `folder`. It rejects absolute names and "..".
MeshSource meshes_in_folder(std::string folder);

/// Limits of the text of a scene.
inline constexpr JsonLimits kSceneLimits{4 * 1024 * 1024, 16, 1'000'000};

/// Reads a scene. Returns all errors of the document and of the scene's values (find_errors()). If
/// the document has errors, find_errors() checks only the parts that were read completely.
Result<Scene> read_scene(const Json& document, const MeshSource& meshes);
Result<Scene> read_scene_text(std::string_view text, const MeshSource& meshes);
/// Reads a scene file and the mesh files in its folder. A scene without a name gets the file name
/// without its extension.
Result<Scene> read_scene_file(const std::string& path);

/// Read one body, interface or material in the format of a scene file. They check the document, not
/// its consistency with a scene. `path` prefixes the paths of errors.
Result<BodyDescription> read_body(const Json& document, const std::string& path,
                                  const MeshSource& meshes);
Result<InterfaceDescription> read_interface(const Json& document, const std::string& path);
Result<Material> read_material(const Json& document, const std::string& path);

/// Returns JSON from which read_scene() makes a bitwise equal scene. Meshes are written inline,
/// with vertices and triangles.
Json write_scene(const Scene& scene);

/// A scene of the catalogue. Its name is the file name without the extension.
struct CatalogueEntry {
  std::string name;
  std::string title;
  std::string description;
};
/// All scenes `*.json` of a folder.
class Catalogue {
 public:
  /// Fails if the folder cannot be read or a file is not a valid scene.
  static Result<Catalogue> open(const std::string& folder);
  const std::vector<CatalogueEntry>& entries() const { return entries_; }
  /// Returns null if there is no such scene.
  const Scene* find(std::string_view name) const;

 private:
  std::vector<CatalogueEntry> entries_;
  std::vector<Scene> scenes_;
};

}  // namespace vat
