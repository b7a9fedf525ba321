#include "protocol/scene/scene_json.h"

#include <set>

#include "core/limits.h"
#include "core/numerics/choose_numerics.h"
#include "core/support/nearest_name.h"
#include "core/validation/validate.h"
#include "protocol/scene/part_names.h"
#include "protocol/scene/scene_parts.h"

namespace vat {
namespace {

/// The parts of a scene without read errors. `..._at` contains the index in the document of each
/// part.
struct PartialScene {
  Scene scene;
  std::vector<std::size_t> materials_at;
  std::vector<std::size_t> interfaces_at;
  std::vector<std::size_t> bodies_at;
  std::vector<std::size_t> emitters_at;
  std::vector<std::size_t> drains_at;
  /// Names of materials with read errors.
  std::set<std::string> broken_materials;
  std::vector<NamedPart> material_names;
  std::vector<NamedPart> body_names;
  bool material_names_known = true;
  bool body_names_known = true;  ///< all bodies were read without errors
};

/// Returns whether a reference to `material` can be checked: it was read, or is not in the
/// document.
bool can_be_checked(const PartialScene& partial, const std::string& material) {
  for (const Material& known : partial.scene.materials) {
    if (known.name == material) return true;
  }
  return partial.material_names_known && partial.broken_materials.count(material) == 0;
}

/// Adds an error if `material` is certainly missing. Used for parts that the core does not check.
void find_missing_material(const PartialScene& partial, const std::string& material,
                           const std::string& path, Errors& errors) {
  const auto& known = partial.scene.materials;
  if (material.empty() || !can_be_checked(partial, material)) return;
  if (std::ranges::find(known, material, &Material::name) != known.end()) return;
  add_error(errors, unknown_name(errors, path, "must be the name of one of the scene's materials",
                                 material, known, &Material::name));
}

/// Calls `read(element, path, errors)` for each element of the list `key`, and then
/// `keep(value, index, intact)` with its result.
template <class Read, class Keep>
void for_elements(ObjectReader& reader, const Json* list, std::string_view key, Errors& errors,
                  Read&& read, Keep&& keep) {
  if (list == nullptr) return;
  for (std::size_t i = 0; i < list->size(); ++i) {
    const std::size_t errors_before = errors.size();
    auto value = read((*list)[i], pointer_to(reader.path_of(key), i), errors);
    const bool intact = errors.size() == errors_before && errors.size() < kMaxReadErrors;
    keep(std::move(value), i, intact);
  }
}

void read_materials(ObjectReader& reader, PartialScene& partial, Errors& errors) {
  const Json* list = reader.array("materials", kMaxMaterials, true);
  partial.material_names_known = list != nullptr;
  for_elements(reader, list, "materials", errors, scene_parts::to_material,
               [&](Material material, std::size_t at, bool intact) {
                 partial.material_names.push_back({at, material.name, intact});
                 if (!intact && material.name == kVatMaterial) {
                   add_error(errors, "reserved_name", pointer_to("/materials", at) + "/name",
                             "must not be \"vat\": that names the walls");
                 }
                 if (intact) {
                   partial.scene.materials.push_back(std::move(material));
                   partial.materials_at.push_back(at);
                 } else if (material.name.empty()) {
                   partial.material_names_known = false;
                 } else {
                   partial.broken_materials.insert(material.name);
                 }
               });
}

void read_interfaces(ObjectReader& reader, PartialScene& partial, Errors& errors) {
  for_elements(reader, reader.array("interfaces", scene_parts::kMaxInterfaces), "interfaces",
               errors, scene_parts::to_interface,
               [&](InterfaceDescription interface, std::size_t at, bool intact) {
                 if (!intact || !can_be_checked(partial, interface.materials[0]) ||
                     !can_be_checked(partial, interface.materials[1])) {
                   return;
                 }
                 partial.scene.interfaces.push_back(std::move(interface));
                 partial.interfaces_at.push_back(at);
               });
}

void read_bodies(ObjectReader& reader, const MeshSource& meshes, PartialScene& partial,
                 Errors& errors) {
  const Json* list = reader.array("bodies", kMaxBodies, true);
  partial.body_names_known = list != nullptr;
  for_elements(
      reader, list, "bodies", errors,
      [&](const Json& value, const std::string& path, Errors&) {
        return scene_parts::to_body(value, path, meshes, errors);
      },
      [&](BodyDescription body, std::size_t at, bool intact) {
        const bool is_known = intact && can_be_checked(partial, body.material) &&
                              (!body.melting || can_be_checked(partial, body.melting->into));
        partial.body_names.push_back({at, body.name, is_known});
        if (!is_known) {
          const std::string path = pointer_to("/bodies", at);
          find_missing_material(partial, body.material, path + "/material", errors);
          if (body.melting) {
            find_missing_material(partial, body.melting->into, path + "/melting/into", errors);
          }
        }
        partial.body_names_known = partial.body_names_known && is_known;
        if (!is_known) return;
        partial.scene.bodies.push_back(std::move(body));
        partial.bodies_at.push_back(at);
      });
}

/// Returns whether a reference to `body` can be checked.
bool is_checked(const PartialScene& partial, const std::string& body) {
  return partial.body_names_known ||
         std::ranges::find(partial.scene.bodies, body, &BodyDescription::name) !=
             partial.scene.bodies.end();
}

void read_flow(ObjectReader& reader, PartialScene& partial, Errors& errors) {
  for_elements(reader, reader.array("emitters", kMaxEmitters), "emitters", errors,
               scene_parts::to_emitter, [&](Emitter emitter, std::size_t at, bool intact) {
                 if (!intact || !is_checked(partial, emitter.body)) return;
                 partial.scene.emitters.push_back(std::move(emitter));
                 partial.emitters_at.push_back(at);
               });
  for_elements(reader, reader.array("drains", kMaxDrains), "drains", errors, scene_parts::to_drain,
               [&](Drain drain, std::size_t at, bool intact) {
                 if (!intact) return;
                 partial.scene.drains.push_back(std::move(drain));
                 partial.drains_at.push_back(at);
               });
}

/// Reads the optional member `key`. `target` does not change if the member has errors.
template <class Target, class Read>
void read_part(ObjectReader& reader, std::string_view key, Target& target, Errors& errors,
               Read&& read) {
  const Json* member = reader.member(key);
  if (member == nullptr) return;
  const std::size_t errors_before = errors.size();
  auto value = read(*member, reader.path_of(key), errors);
  if (errors.size() == errors_before) target = std::move(value);
}

/// Reads a value of an enumeration by name. Without the member it keeps its default.
template <class Enum>
void read_choice(ObjectReader& reader, std::string_view key, Enum& value) {
  value = scene_parts::read_enum<Enum>(reader, key, value);
}

/// Reads the members that apply to all liquids of the scene.
void read_liquid_model(ObjectReader& reader, Scene& scene) {
  read_choice(reader, "pressure_solver", scene.pressure_solver);
  scene.printed_pressure_force =
      reader.boolean("printed_pressure_force", scene.printed_pressure_force);
  read_choice(reader, "kernel", scene.kernel);
  read_choice(reader, "pair_precision", scene.pair_precision);
  read_choice(reader, "surface_tension_model", scene.surface_model);
}

PartialScene read_document(const Json& document, const MeshSource& meshes, Errors& errors) {
  PartialScene partial;
  Scene& scene = partial.scene;
  ObjectReader reader(document, "", errors);
  reader.choice("format", {"vat.scene/1"});
  reader.text("$schema", kMaxTextLength, "");  // only for editors
  scene.name = reader.text("name", kMaxNameLength, "");
  scene.title = reader.text("title", kMaxTextLength, "");
  scene.description = reader.text("description", kMaxTextLength, "");
  read_liquid_model(reader, scene);
  scene.dimensions = static_cast<int>(reader.count("dimensions", 2, 3, 3));
  scene.gravity = reader.vector("gravity", kAnyMin, kAnyMax, scene.gravity);
  read_materials(reader, partial, errors);
  read_part(reader, "default_interface", scene.default_interface, errors,
            scene_parts::to_interface_constants);
  read_interfaces(reader, partial, errors);
  read_part(reader, "vat", scene.vat, errors, scene_parts::to_vat);
  read_part(reader, "periodic", scene.periodic, errors, scene_parts::to_periodicity);
  read_part(reader, "central_field", scene.central_field, errors, scene_parts::to_central_field);
  read_part(reader, "settling", scene.settling, errors, scene_parts::to_settling);
  read_part(reader, "sleeping", scene.sleeping, errors, scene_parts::to_sleeping);
  read_part(reader, "incompressible", scene.incompressible, errors, scene_parts::to_incompressible);
  read_part(reader, "forces", scene.forces, errors, scene_parts::to_force_switches);
  read_part(reader, "numerics", scene.numerics, errors, scene_parts::to_numerics);
  read_bodies(reader, meshes, partial, errors);
  read_flow(reader, partial, errors);
  reader.refuse_unknown();
  return partial;
}

/// Returns the value, or the errors of its reader.
template <class T>
Result<T> unless_failed(T value, const Errors& errors) {
  if (!errors.empty()) return errors;
  return value;
}

/// Converts a JSON pointer of the partial scene to one of the document.
std::string document_path(const std::string& path, std::string_view list,
                          const std::vector<std::size_t>& at) {
  const std::string prefix = pointer_to("", list) + '/';
  if (path.compare(0, prefix.size(), prefix) != 0) return path;
  const std::size_t end = std::min(path.find('/', prefix.size()), path.size());
  const std::size_t index = std::stoul(path.substr(prefix.size(), end - prefix.size()));
  return pointer_to(pointer_to("", list), at.at(index)) + path.substr(end);
}

}  // namespace

Result<Scene> read_scene(const Json& document, const MeshSource& meshes) {
  Errors errors;
  PartialScene partial = read_document(document, meshes, errors);
  for (Error& error : find_errors(partial.scene)) {
    std::string path = document_path(error.path, "materials", partial.materials_at);
    path = document_path(path, "interfaces", partial.interfaces_at);
    path = document_path(path, "bodies", partial.bodies_at);
    path = document_path(path, "emitters", partial.emitters_at);
    path = document_path(path, "drains", partial.drains_at);
    add_error(errors, std::move(error.code), std::move(path), std::move(error.message));
  }
  find_repeated_names(partial.material_names, "materials", errors);
  find_repeated_names(partial.body_names, "bodies", errors);
  if (!errors.empty()) return errors;
  resolve_accuracy(partial.scene);
  return std::move(partial.scene);
}

Result<Scene> read_scene_text(std::string_view text, const MeshSource& meshes) {
  const Result<Json> document = parse_json(text, kSceneLimits);
  if (!document) return document.errors();
  return read_scene(document.value(), meshes);
}

Result<BodyDescription> read_body(const Json& document, const std::string& path,
                                  const MeshSource& meshes) {
  Errors errors;
  return unless_failed(scene_parts::to_body(document, path, meshes, errors), errors);
}

Result<InterfaceDescription> read_interface(const Json& document, const std::string& path) {
  Errors errors;
  return unless_failed(scene_parts::to_interface(document, path, errors), errors);
}

Result<Material> read_material(const Json& document, const std::string& path) {
  Errors errors;
  return unless_failed(scene_parts::to_material(document, path, errors), errors);
}

}  // namespace vat
