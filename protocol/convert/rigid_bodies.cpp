#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <tuple>

#include "core/sampling/mesh.h"
#include "protocol/convert/conversion.h"

namespace vat::conversion {
namespace {

/// Constants of a rigid body. Bodies with the same constants share a material.
struct SolidConstants {
  Real density = 1000;
  Real restitution = 0.6;
  Real friction = 0.2;
  std::string colour;

  bool operator<(const SolidConstants& other) const {
    return std::tie(density, restitution, friction, colour) <
           std::tie(other.density, other.restitution, other.friction, other.colour);
  }
};

struct Solids {
  std::map<SolidConstants, std::string> names;
  bool has_dynamic = false;
};

/// Returns "#rrggbb", or an empty text without a colour.
std::string read_colour(SourceObject& body, Report& report) {
  const Json* colour = body.member("color");
  if (colour == nullptr) return {};
  const std::string path = body.path_of("color");
  if (to_array(*colour, path, 3, 4, report.errors) == nullptr) return {};
  std::array<unsigned, 3> parts{};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto part = to_real((*colour)[i], pointer_to(path, i), 0, 1, report.errors);
    parts[i] = static_cast<unsigned>(std::lround(255 * part.value_or(0)));
  }
  char text[8];
  std::snprintf(text, sizeof text, "#%02x%02x%02x", parts[0] & 255U, parts[1] & 255U,
                parts[2] & 255U);
  return text;
}

SolidConstants read_constants(SourceObject& body, bool is_dynamic, Report& report) {
  SolidConstants constants;
  const Real density = body.real("density", kMinDensity, kMaxDensity, 1000);
  if (is_dynamic) constants.density = density;  // the mass of fixed bodies has no effect
  constants.restitution = body.real("restitution", 0, 1, constants.restitution);
  constants.friction = body.real("friction", 0, kMaxFriction / 2, constants.friction);
  constants.colour = read_colour(body, report);
  return constants;
}

/// Returns the name of the material with these constants, and adds it at its first use.
std::string material_of(const SolidConstants& constants, Solids& solids, const std::string& path,
                        Conversion& conversion) {
  const auto [found, is_new] =
      solids.names.try_emplace(constants, "solid " + std::to_string(solids.names.size() + 1));
  if (is_new) {
    Json json = {{"name", found->second}, {"density", tidy(constants.density)}};
    if (!constants.colour.empty()) json["appearance"] = {{"colour", constants.colour}};
    conversion.scene["materials"].push_back(std::move(json));
    conversion.material_sources.push_back(path);
  }
  return found->second;
}

/// Omits the members that static and dynamic bodies have in common.
void omit_settings(SourceObject& body) {
  body.omit(
      {"mapThickness", "mapResolution", "mapFile", "samplingMode", "particleFile", "resolutionSDF"},
      "vat fills bodies with a cubic lattice");
  body.omit({"collisionObjectType", "collisionObjectScale", "collisionObjectFileName", "testMesh",
             "thicknessSDF", "invertSDF"},
            "contacts are between the particles of bodies");
  body.omit({"id", "isWall"}, "vat does not need this member");
  body.omit({"isAnimated"}, "scripts are not converted; the body is at rest");
  body.omit_rest();
}

MeshShape placed(MeshShape mesh, const Placement& placement) {
  for (Vec3& vertex : mesh.vertices) vertex = placement.orientation * vertex + placement.position;
  return mesh;
}

bool holds(const std::pair<Vec3, Vec3>& box, const Vec3& point) {
  return (point.array() >= box.first.array()).all() && (point.array() <= box.second.array()).all();
}

/// Returns whether a static box is around the liquids.
bool is_container(const std::pair<Vec3, Vec3>& box, const Conversion& conversion) {
  return !conversion.liquid_centers.empty() &&
         std::ranges::all_of(conversion.liquid_centers,
                             [&](const Vec3& center) { return holds(box, center); });
}

/// Moves vertices outside of the container to its walls. Returns whether a part thicker than half
/// a spacing remains. Closed meshes remain closed.
bool cut_to_container(MeshShape& mesh, Conversion& conversion, const std::string& path) {
  if (!conversion.container || mesh.vertices.empty()) return true;
  const auto& [min, max] = *conversion.container;
  bool is_cut = false;
  Vec3 low = max;
  Vec3 high = min;
  for (Vec3& vertex : mesh.vertices) {
    const Vec3 inside = vertex.cwiseMax(min).cwiseMin(max);
    is_cut = is_cut || (inside - vertex).norm() > 1e-3 * conversion.spacing;
    vertex = inside;
    low = low.cwiseMin(inside);
    high = high.cwiseMax(inside);
  }
  if (((high - low).array() < conversion.spacing / 2).any()) {
    conversion.report.omit(path, "the body is outside of the container");
    return false;
  }
  if (is_cut) conversion.report.omit(path, "the parts outside of the container");
  return true;
}

/// A rigid body of the source with its mesh, before its place in the scene is known.
struct SourceBody {
  SourceObject object;
  MeshShape mesh;
  Placement placement;
  bool is_dynamic;
  bool is_inverted;
};

std::optional<SourceBody> open_body(const Json& value, const std::string& path,
                                    Conversion& conversion) {
  SourceObject object(value, path, conversion.report);
  const std::string file = object.text("geometryFile", "");
  const bool is_dynamic = object.boolean("isDynamic", false);
  const bool is_inverted = object.boolean("mapInvert", false);
  const Placement placement = read_placement(object, Vec3::UnitX());
  const Vec3 scale = object.scale();
  if (file.empty()) {
    conversion.report.omit(path, "the body has no geometryFile");
    return {};
  }
  auto mesh = read_geometry(conversion, file, object.path_of("geometryFile"), scale);
  if (!mesh) return {};
  return SourceBody{object, std::move(*mesh), placement, is_dynamic, is_inverted};
}

/// Makes a static box the vat, if it is around the liquids. Returns whether the body is done.
bool take_container(SourceBody& body, Conversion& conversion) {
  if (body.is_dynamic) return false;
  const std::string& path = body.object.path();
  const auto box = box_of(placed(body.mesh, body.placement));
  const bool is_around = box && is_container(*box, conversion);
  if (!body.is_inverted && !is_around) return false;
  if (!box || conversion.container) {
    conversion.report.omit(
        path, box ? "a scene has one container" : "a container must be a box along the axes");
    return true;
  }
  conversion.container = box;
  conversion.scene["vat"] = {
      {"min", tidy_json(box->first)}, {"max", tidy_json(box->second)}, {"lid", true}};
  body.object.omit({"color", "density", "restitution", "friction"},
                   "the vat has no material of its own");
  omit_settings(body.object);
  return true;
}

void add_rigid_body(SourceBody& body, Solids& solids, Conversion& conversion) {
  const std::string& path = body.object.path();
  if (conversion.is_flat && !box_of(body.mesh)) {
    conversion.report.omit(path, "two-dimensional scenes have no meshes");
    return;
  }
  if (!is_closed(body.mesh)) {
    conversion.report.omit(path, "its mesh is not closed, so that it has no inside");
    return;
  }
  Json json = {{"kind", "rigid"}, {"spacing", tidy(conversion.spacing)}};
  if (body.is_dynamic) {
    const Vec3 velocity = z_up(body.object.vector("velocity", kMaxSpeed, Vec3::Zero()));
    const Vec3 spin = z_up(body.object.vector("angularVelocity", kMaxAngularSpeed, Vec3::Zero()));
    if (!velocity.isZero()) json["velocity"] = tidy_json(velocity);
    if (!spin.isZero()) json["angular_velocity"] = tidy_json(spin);
    write_placement(body.placement, json);
    solids.has_dynamic = true;
  } else {
    body.mesh = placed(std::move(body.mesh), body.placement);
    if (!cut_to_container(body.mesh, conversion, path)) return;
    json["fixed"] = true;
  }
  json["shape"] = shape_json(body.mesh);
  conversion.particles += mesh_volume(body.mesh) / std::pow(conversion.spacing, 3);
  if (conversion.is_flat) {
    if (json["shape"].contains("center")) json["shape"]["center"][1] = 0;
    if (json.contains("position")) json["position"][1] = 0;
  }
  json["name"] = (body.is_dynamic ? "body " : "obstacle ") +
                 std::to_string(conversion.body_sources.size() + 1);
  json["material"] = material_of(read_constants(body.object, body.is_dynamic, conversion.report),
                                 solids, path, conversion);
  omit_settings(body.object);
  conversion.scene["bodies"].push_back(std::move(json));
  conversion.body_sources.push_back(path);
}

Json projection(Real restitution, Real friction) {
  return {{"law", "projection"}, {"restitution", tidy(restitution)}, {"friction", tidy(friction)}};
}

/// Adds the interfaces of rigid bodies. In the source, the restitution of a contact is the product
/// of both bodies' values, and its friction the sum.
void add_interfaces(const Solids& solids, Conversion& conversion) {
  const bool has_elastic = std::ranges::any_of(
      conversion.materials, [](const auto& material) { return material.second.is_elastic; });
  if (solids.names.empty() && !has_elastic) return;
  conversion.scene["default_interface"] = projection(0, 0.2);
  if (!solids.has_dynamic) return;
  Json interfaces = Json::array();
  const SolidConstants wall;
  for (auto a = solids.names.begin(); a != solids.names.end(); ++a) {
    Json with_wall =
        projection(a->first.restitution * wall.restitution, a->first.friction + wall.friction);
    with_wall["materials"] = {a->second, "vat"};
    if (conversion.container) interfaces.push_back(std::move(with_wall));
    for (auto b = a; b != solids.names.end(); ++b) {
      Json pair = projection(a->first.restitution * b->first.restitution,
                             a->first.friction + b->first.friction);
      pair["materials"] = {a->second, b->second};
      interfaces.push_back(std::move(pair));
    }
  }
  conversion.scene["interfaces"] = std::move(interfaces);
}

}  // namespace

void read_rigid_bodies(const Json& document, Conversion& conversion) {
  std::vector<SourceBody> bodies;
  for_each_in(document, "RigidBodies", conversion, [&](const Json& value, const std::string& path) {
    if (auto body = open_body(value, path, conversion)) bodies.push_back(std::move(*body));
  });
  // The container is first, because obstacles end at its walls.
  std::erase_if(bodies, [&](SourceBody& body) { return take_container(body, conversion); });
  Solids solids;
  for (SourceBody& body : bodies) add_rigid_body(body, solids, conversion);
  add_interfaces(solids, conversion);
}

}  // namespace vat::conversion
