#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <functional>
#include <string>
#include <vector>

#include "core/support/nearest_name.h"
#include "protocol/python/native/bindings.h"
#include "protocol/scene/level.h"
#include "protocol/scene/scene_json.h"

namespace py = pybind11;

namespace vat::python {
namespace {

/// Returns the scene of a text at a level, in the format of a scene file.
std::string at_level_text(const std::string& text, const std::string& folder,
                          const std::string& name) {
  const std::optional<Level> level = find_level(name);
  if (!level) throw py::value_error("level must be coarse, normal, fine or finest");
  Scene scene = value_of(read_scene_text(text, meshes_in_folder(folder)));
  return write_scene(value_of(at_level(std::move(scene), *level))).dump();
}

}  // namespace

void bind_scenes(py::module_& module) {
  module.def("read_scene_file", [](const std::string& path) {
    return write_scene(value_of(read_scene_file(path))).dump();
  });
  module.def("at_level", &at_level_text);
  module.def("refuse_unknown_scene",
             [](const std::string& name, const std::vector<std::string>& names) {
               std::string message = "the catalogue has no scene '" + name + "'; it has";
               for (const std::string& other : names) message += ' ' + other;
               NearestName nearest(name);
               nearest.consider_all(names, std::identity());
               raise({with_suggestion({"unknown_scene", "", message}, nearest.suggestion())});
             });
}

}  // namespace vat::python
