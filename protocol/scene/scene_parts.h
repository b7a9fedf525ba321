#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/scene.h"
#include "protocol/json/json_reader.h"
#include "protocol/scene/scene_json.h"

/// Readers of the parts of a scene. Each reader adds errors to `errors` and returns a value. The
/// value is valid only if the reader added no error.
namespace vat::scene_parts {

/// Limits of the file format. core/limits.h defines the limits of the values.
inline constexpr std::size_t kMaxFileName = 256;
// Sufficient for all pairs of 64 materials and the vat.
inline constexpr std::size_t kMaxInterfaces = 4096;

/// Returns an enumerator by its name. Without a fallback, the member is required.
template <class Enum>
Enum read_enum(ObjectReader& reader, std::string_view key, std::optional<Enum> fallback = {}) {
  std::optional<std::size_t> index;
  if (fallback) index = static_cast<std::size_t>(*fallback);
  return static_cast<Enum>(reader.choice(key, kNamesOf<Enum>, index));
}

/// Assigns `read(value, path, errors)` to `target` if the member `key` is present.
template <class Target, class Read>
void read_member(ObjectReader& reader, std::string_view key, Target& target, Errors& errors,
                 Read&& read) {
  if (const Json* value = reader.member(key)) target = read(*value, reader.path_of(key), errors);
}

/// Returns a list of vectors. The magnitude of each component must be at most `bound`.
std::vector<Vec3> read_vectors(ObjectReader& reader, std::string_view key, Real bound,
                               bool required, Errors& errors);
/// Returns a quaternion without normalisation. The core reports an error if the length is far from
/// 1.
Quat to_orientation(const Json& value, const std::string& path, Errors& errors);
/// Returns the spring constants among the members of an object.
SpringConstants to_spring_constants(ObjectReader& reader);
/// Returns the constants of an interface, without materials and threshold.
InterfaceConstants to_interface_constants(const Json& value, std::string path, Errors& errors);
Material to_material(const Json& value, std::string path, Errors& errors);
InterfaceDescription to_interface(const Json& value, std::string path, Errors& errors);
/// Returns the sliding motion of the vat or of a driven body.
SlideMotion to_motion(const Json& value, std::string path, Errors& errors);
Vat to_vat(const Json& value, std::string path, Errors& errors);
Periodicity to_periodicity(const Json& value, std::string path, Errors& errors);
CentralField to_central_field(const Json& value, std::string path, Errors& errors);
Settling to_settling(const Json& value, std::string path, Errors& errors);
Sleeping to_sleeping(const Json& value, std::string path, Errors& errors);
Emitter to_emitter(const Json& value, std::string path, Errors& errors);
Drain to_drain(const Json& value, std::string path, Errors& errors);
IncompressibleSolve to_incompressible(const Json& value, std::string path, Errors& errors);
ForceSwitches to_force_switches(const Json& value, std::string path, Errors& errors);
Numerics to_numerics(const Json& value, std::string path, Errors& errors);
/// Returns a field, including its waves. The magnitude of its values must be at most `bound`.
VectorField to_field(const Json& value, std::string path, Real bound, Errors& errors);
Shape to_shape(const Json& value, const std::string& path, const MeshSource& meshes,
               Errors& errors);
BodyDescription to_body(const Json& value, const std::string& path, const MeshSource& meshes,
                        Errors& errors);

}  // namespace vat::scene_parts
