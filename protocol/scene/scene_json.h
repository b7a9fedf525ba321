#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/scene.h"
#include "core/support/result.h"
#include "protocol/json/json_reader.h"

namespace vat {

/// Gives the text of the `.obj` file that a scene names, or an error. A server hands in one that
/// knows its catalogue only, so that a client cannot read files.
using MeshSource = std::function<Result<std::string>(const std::string& name)>;

/// A source that reads `name` below `folder`; refuses absolute names and "..".
MeshSource meshes_in_folder(std::string folder);

/// Bounds of the text of a scene.
inline constexpr JsonLimits kSceneLimits{4 * 1024 * 1024, 16, 1'000'000};

/// JSON -> Scene. Returns the scene only if both the document and the scene (find_errors) are
/// without errors; otherwise all of them. Where the document has errors, find_errors sees only the
/// parts that were read fully.
Result<Scene> read_scene(const Json& document, const MeshSource& meshes);
Result<Scene> read_scene_text(std::string_view text, const MeshSource& meshes);
/// Reads a scene file and the meshes beside it. A scene without a name gets the file's, without its
/// ending.
Result<Scene> read_scene_file(const std::string& path);

/// One body, interface or material, as in a scene file; checks the document only. `path` prefixes
/// errors.
Result<BodyDescription> read_body(const Json& document, const std::string& path,
                                  const MeshSource& meshes);
Result<InterfaceDescription> read_interface(const Json& document, const std::string& path);
Result<Material> read_material(const Json& document, const std::string& path);

/// Scene -> JSON that read_scene takes back to an equal scene, bit by bit. Meshes are written with
/// their vertices and triangles, so that the result stands alone.
Json write_scene(const Scene& scene);

/// The catalogue: every `*.json` of a folder, by name (the file name without its ending).
struct CatalogueEntry {
  std::string name;
  std::string title;
  std::string description;
};
class Catalogue {
 public:
  /// Fails where the folder cannot be read or an entry is not a valid scene.
  static Result<Catalogue> open(const std::string& folder);
  const std::vector<CatalogueEntry>& entries() const { return entries_; }
  /// Null where there is no such scene.
  const Scene* find(std::string_view name) const;

 private:
  std::vector<CatalogueEntry> entries_;
  std::vector<Scene> scenes_;
};

}  // namespace vat
