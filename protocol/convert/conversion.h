#pragma once

#include <initializer_list>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/limits.h"
#include "core/scene/body.h"
#include "protocol/convert/splishsplash.h"

/// Parts of the conversion of SPlisHSPlasH scenes.
namespace vat::conversion {

/// Errors and omissions of a conversion.
struct Report {
  Errors errors;
  std::vector<Omission> omissions;

  void omit(std::string path, std::string reason) {
    omissions.push_back({std::move(path), std::move(reason)});
  }
};

/// Reader of one object of the source. Wrong values are errors, and members without a counterpart
/// are omissions. All members are optional.
class SourceObject {
 public:
  SourceObject(const Json& value, std::string path, Report& report)
      : value_(&value),
        path_(std::move(path)),
        report_(&report),
        reader_(value, path_, report.errors) {}

  const std::string& path() const { return path_; }
  std::string path_of(std::string_view key) const { return pointer_to(path_, key); }
  bool has(std::string_view key) const { return value_->is_object() && value_->contains(key); }

  const Json* member(std::string_view key) { return reader_.member(used(key)); }
  Real real(std::string_view key, Real min, Real max, Real fallback) {
    return reader_.real(used(key), min, max, fallback);
  }
  std::uint64_t count(std::string_view key, std::uint64_t min, std::uint64_t max,
                      std::uint64_t fallback) {
    return reader_.count(used(key), min, max, fallback);
  }
  /// The source can give a bool as 0 or 1.
  bool boolean(std::string_view key, bool fallback);
  std::string text(std::string_view key, const std::string& fallback) {
    return reader_.text(used(key), kMaxTextLength, fallback);
  }
  /// The magnitude of each component is at most `bound`.
  Vec3 vector(std::string_view key, Real bound, const Vec3& fallback) {
    return reader_.vector(used(key), -bound, bound, fallback);
  }
  /// Returns three factors, which the source can give as one number.
  Vec3 scale();

  /// Adds an omission for each of these members that is present and was not read.
  void omit(std::initializer_list<const char*> keys, const char* reason);
  /// Adds an omission for each member that was not read.
  void omit_rest();

 private:
  std::string_view used(std::string_view key) {
    used_.emplace(key);
    return key;
  }

  const Json* value_;
  std::string path_;
  Report* report_;
  ObjectReader reader_;
  std::set<std::string, std::less<>> used_;
};

/// Material of particles. The ids of the source refer to it.
struct LiquidMaterial {
  std::string name;
  bool is_elastic = false;
  std::size_t most_emitted = 10'000;
};

/// Rotation and translation of an object, with z up.
struct Placement {
  Vec3 position = Vec3::Zero();
  Quat orientation = Quat::Identity();
};

/// State of a conversion. The readers of the parts add to `scene`.
struct Conversion {
  explicit Conversion(const MeshSource& files) : meshes(&files) {}

  Report report;
  const MeshSource* meshes;
  bool is_flat = false;        ///< two dimensions
  Real spacing = 0;            ///< distance of particles [m]
  std::size_t method = 0;      ///< simulationMethod
  Real pressure_constant = 0;  ///< stiffness × exponent of the equation of state [Pa]
  Real particles = 0;          ///< estimate, of all bodies
  Real fastest_emitter = 0;    ///< [m/s]
  Real longest_step = 0;       ///< [s]
  bool is_adaptive = false;
  std::map<std::string, LiquidMaterial> materials;  ///< by their ids
  std::vector<Vec3> liquid_centers;
  /// First liquid body of each material, and its number of particles.
  std::map<std::string, std::pair<std::string, Real>> bodies;
  std::optional<std::pair<Vec3, Vec3>> container;
  Json scene = Json::object();
  std::vector<std::string> material_sources;  ///< paths of the source, by index
  std::vector<std::string> body_sources;
  std::vector<std::string> emitter_sources;
};

/// Returns a vector of the source, in which y is up, with z up.
inline Vec3 z_up(const Vec3& v) {
  return {v.x(), -v.z(), v.y()};
}

/// Returns the number without the rounding errors of the conversion.
Real tidy(Real value, int digits = 12);
Json tidy_json(const Vec3& vector, int digits = 12);

/// Reads translation, rotationAxis and rotationAngle.
Placement read_placement(SourceObject& object, const Vec3& default_axis);
/// Adds the members position and orientation, if they differ from the defaults.
void write_placement(const Placement& placement, Json& body);

/// Returns a mesh of the source, scaled, with z up, or nothing after an error.
std::optional<MeshShape> read_geometry(Conversion& conversion, const std::string& file,
                                       const std::string& path, const Vec3& scale);
/// Returns the shape of a mesh: a box, or the mesh with its vertices rounded to 7 digits.
Json shape_json(const MeshShape& mesh);
/// Returns the corners of a mesh that is a box along the axes.
std::optional<std::pair<Vec3, Vec3>> box_of(const MeshShape& mesh);
Json box_json(const Vec3& min, const Vec3& max);

/// Calls `read(object, path)` for each element of a list of the document.
template <class Read>
void for_each_in(const Json& document, const char* list, Conversion& conversion, Read&& read) {
  const auto found = document.find(list);
  if (found == document.end()) return;
  const std::string path = pointer_to("", list);
  if (to_array(*found, path, 0, kMaxBodies, conversion.report.errors) == nullptr) return;
  for (std::size_t i = 0; i < found->size(); ++i) read((*found)[i], pointer_to(path, i));
}

void read_configuration(const Json& document, Conversion& conversion);
/// Adds the materials of all ids that blocks, models and emitters use.
void read_materials(const Json& document, Conversion& conversion);
void read_blocks(const Json& document, Conversion& conversion);
void read_models(const Json& document, Conversion& conversion);
void read_emitters(const Json& document, Conversion& conversion);
void read_rigid_bodies(const Json& document, Conversion& conversion);
/// Reduces the particles of emitters to the limit of a scene.
void limit_emitters(Conversion& conversion);
/// Adds the numerics, which depend on the other parts.
void add_numerics(Conversion& conversion);

}  // namespace vat::conversion
