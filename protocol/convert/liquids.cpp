#include <algorithm>
#include <cmath>

#include "core/sampling/mesh.h"
#include "protocol/convert/conversion.h"

namespace vat::conversion {
namespace {

/// Returns the material of a block, model or emitter, which read_materials() has added.
const LiquidMaterial& read_material_id(SourceObject& object, Conversion& conversion) {
  const auto found = conversion.materials.find(object.text("id", "Fluid"));
  static const LiquidMaterial kUnknown;  // after an error
  return found == conversion.materials.end() ? kUnknown : found->second;
}

/// Adds a body of particles. `particles` is its approximate number of particles.
void add_body(SourceObject& object, const LiquidMaterial& material, std::string name, Json body,
              Real particles, Conversion& conversion) {
  const Vec3 velocity = z_up(object.vector("initialVelocity", kMaxSpeed, Vec3::Zero()));
  const Vec3 spin = z_up(object.vector("initialAngularVelocity", kMaxAngularSpeed, Vec3::Zero()));
  if (!velocity.isZero()) body["velocity"] = tidy_json(velocity);
  if (!spin.isZero()) body["angular_velocity"] = tidy_json(spin);
  if (object.count("denseMode", 0, 2, 0) != 0) {
    conversion.report.omit(object.path_of("denseMode"), "vat fills shapes with a cubic lattice");
  }
  object.omit({"visMesh"}, "a setting of pictures");
  object.omit_rest();
  conversion.particles += particles;
  if (!material.is_elastic) conversion.bodies.try_emplace(material.name, name, particles);
  body["name"] = std::move(name);
  body["kind"] = material.is_elastic ? "deformable" : "liquid";
  body["material"] = material.name;
  body["spacing"] = tidy(conversion.spacing);
  conversion.scene["bodies"].push_back(std::move(body));
  conversion.body_sources.push_back(object.path());
}

void read_block(const Json& value, const std::string& path, Conversion& conversion) {
  SourceObject block(value, path, conversion.report);
  const LiquidMaterial& material = read_material_id(block, conversion);
  const Vec3 start = block.vector("start", kMaxLength, Vec3::Zero());
  const Vec3 end = block.vector("end", kMaxLength, Vec3::Ones());
  const Vec3 translation = block.vector("translation", kMaxLength, Vec3::Zero());
  const Vec3 scale = block.scale();
  const int axes = conversion.is_flat ? 2 : 3;
  if (!((end - start).head(axes).array() > 0).all()) {
    add_error(conversion.report.errors, "out_of_range", block.path_of("end"),
              "must be above start along every axis");
    return;
  }
  Vec3 min = start.cwiseProduct(scale) + translation;
  Vec3 size = (end - start).cwiseProduct(scale);
  if (conversion.is_flat) {
    size.z() = conversion.spacing;
    min.z() = -size.z() / 2;
  }
  const Vec3 center = z_up(min + size / 2);
  conversion.liquid_centers.push_back(center);
  const Vec3 half = z_up(size).cwiseAbs() / 2;
  Real particles = 1;
  for (const Real edge : size)
    particles *= std::max<Real>(1, std::round(edge / conversion.spacing));
  Json body = {{"shape", box_json(center - half, center + half)}};
  const std::string name = "block " + std::to_string(conversion.body_sources.size() + 1);
  add_body(block, material, name, std::move(body), particles, conversion);
}

void read_model(const Json& value, const std::string& path, Conversion& conversion) {
  SourceObject model(value, path, conversion.report);
  const std::string file = model.text("particleFile", "");
  if (!file.ends_with(".obj")) {
    conversion.report.omit(path, "vat reads .obj models only, not the particles of '" + file + "'");
    return;
  }
  if (conversion.is_flat) {
    conversion.report.omit(path, "two-dimensional scenes have no meshes");
    return;
  }
  const LiquidMaterial& material = read_material_id(model, conversion);
  if (model.boolean("invert", false)) {
    conversion.report.omit(model.path_of("invert"), "a body fills the inside of its mesh");
  }
  model.omit({"resolutionSDF"}, "vat samples meshes exactly");
  const Placement placement = read_placement(model, Vec3::UnitX());
  const auto mesh = read_geometry(conversion, file, model.path_of("particleFile"), model.scale());
  if (!mesh) return;
  Json body = {{"shape", shape_json(*mesh)}};
  write_placement(placement, body);
  conversion.liquid_centers.push_back(placement.position);
  const std::string name = "model " + std::to_string(conversion.body_sources.size() + 1);
  const Real particles = mesh_volume(*mesh) / std::pow(conversion.spacing, 3);
  add_body(model, material, name, std::move(body), particles, conversion);
}

/// Returns the name of the body that an emitter feeds, and its number of particles. Adds a body of
/// one particle at `start` if there is none.
std::pair<std::string, Real> fed_body(const LiquidMaterial& material, const Vec3& start,
                                      const std::string& path, Conversion& conversion) {
  const auto found = conversion.bodies.find(material.name);
  if (found != conversion.bodies.end()) return found->second;
  const std::string name = "drop " + std::to_string(conversion.body_sources.size() + 1);
  const Vec3 half = Vec3::Constant(conversion.spacing / 2);
  conversion.scene["bodies"].push_back({{"name", name},
                                        {"kind", "liquid"},
                                        {"material", material.name},
                                        {"spacing", tidy(conversion.spacing)},
                                        {"shape", box_json(start - half, start + half)}});
  conversion.body_sources.push_back(path);
  conversion.bodies.try_emplace(material.name, name, 1);
  return {name, 1};
}

/// Returns the edge lengths of a rectangular opening, the horizontal edge first. vat turns
/// rectangular openings so that one edge is horizontal.
Json opening_size(SourceObject& emitter, const Quat& turn, Conversion& conversion) {
  const Real width = emitter.real("width", 1, 10'000, 5) * conversion.spacing;
  const Real height = emitter.real("height", 1, 10'000, 5) * conversion.spacing;
  // In the source, x is the direction of the flow, y the height and z the width.
  const Vec3 flow = turn * z_up(Vec3::UnitX());
  const Vec3 along_height = turn * z_up(Vec3::UnitY());
  const bool is_vertical = std::abs(flow.z()) > 0.999;
  const Vec3 first =
      is_vertical ? Vec3(Vec3::UnitX()) : Vec3(flow.cross(Vec3::UnitZ()).normalized());
  const Real share = std::abs(along_height.dot(first));  // the cosine of the angle
  if (share > 0.05 && share < 0.95) {
    conversion.report.omit(emitter.path_of("rotationAngle"),
                           "the rotation about the flow: one edge of an opening is horizontal");
  }
  const bool is_height_first = share > 0.5;
  return {tidy(is_height_first ? height : width), tidy(is_height_first ? width : height)};
}

void read_emitter(const Json& value, const std::string& path, Conversion& conversion) {
  SourceObject emitter(value, path, conversion.report);
  const LiquidMaterial& material = read_material_id(emitter, conversion);
  if (material.is_elastic) {
    conversion.report.omit(path, "emitters feed liquids only");
    return;
  }
  Placement placement = read_placement(emitter, Vec3::UnitZ());
  if (conversion.is_flat) {
    const Real angle = emitter.real("rotationAngle", -1e3, 1e3, 0);
    placement.orientation = Eigen::AngleAxis<Real>(angle, z_up(Vec3::UnitZ()));
    placement.position.y() = 0;
  }
  const Vec3 direction = placement.orientation * z_up(Vec3::UnitX());
  // Both programs move particles in a tube of one support radius. It begins at the translation.
  const Vec3 opening = placement.position + 2 * conversion.spacing * direction;
  const Real speed = emitter.real("velocity", 1e-6, kMaxSpeed, 1);
  Json json = {{"name", "emitter " + std::to_string(conversion.emitter_sources.size() + 1)},
               {"position", tidy_json(opening)},
               {"direction", tidy_json(direction)},
               {"speed", tidy(speed)}};
  const bool is_round = emitter.count("type", 0, 1, 0) == 1;
  if (is_round || conversion.is_flat) {
    const Real width = emitter.real(is_round ? "width" : "height", 1, 10'000, 5);
    json["radius"] = tidy(width * conversion.spacing / 2);
    emitter.omit({"width", "height"}, "the opening has one width");
  } else {
    json["size"] = opening_size(emitter, placement.orientation, conversion);
  }
  const Real from = emitter.real("emitStartTime", 0, Emitter::kNoEnd, 0);
  const Real until = emitter.real("emitEndTime", 0, kAnyMax, Emitter::kNoEnd);
  if (from > 0) json["from"] = from;
  if (until < Emitter::kNoEnd) json["until"] = until;
  emitter.omit_rest();
  const auto [body, particles] =
      fed_body(material, opening + conversion.spacing * direction, path, conversion);
  json["body"] = body;
  json["most_particles"] = static_cast<std::uint64_t>(particles) + material.most_emitted;
  conversion.fastest_emitter = std::max(conversion.fastest_emitter, speed);
  conversion.liquid_centers.push_back(opening);
  conversion.scene["emitters"].push_back(std::move(json));
  conversion.emitter_sources.push_back(path);
}

}  // namespace

void read_blocks(const Json& document, Conversion& conversion) {
  for_each_in(document, "FluidBlocks", conversion, [&](const Json& value, const std::string& path) {
    read_block(value, path, conversion);
  });
}

void read_models(const Json& document, Conversion& conversion) {
  for_each_in(document, "FluidModels", conversion, [&](const Json& value, const std::string& path) {
    read_model(value, path, conversion);
  });
}

void limit_emitters(Conversion& conversion) {
  std::map<std::string, Real> emitted;  // by the name of the body
  const auto emitters = conversion.scene.find("emitters");
  if (emitters == conversion.scene.end()) return;
  for (const Json& emitter : *emitters) {
    emitted[emitter["body"].get<std::string>()] = emitter["most_particles"].get<Real>();
  }
  Real sum = 0;
  for (const auto& [body, most] : emitted) sum += most;
  // A margin, because the numbers of particles of bodies are estimates.
  const Real room = 0.95 * kMaxParticles - conversion.particles;
  if (!(sum > room) || !(room > 0)) return;
  for (std::size_t e = 0; e < emitters->size(); ++e) {
    Json& most = (*emitters)[e]["most_particles"];
    most = static_cast<std::uint64_t>(most.get<Real>() * room / sum);
    conversion.report.omit(conversion.emitter_sources[e],
                           "particles beyond " + most.dump() + ": a scene has at most 1000000");
  }
}

void read_emitters(const Json& document, Conversion& conversion) {
  for_each_in(document, "Emitters", conversion, [&](const Json& value, const std::string& path) {
    read_emitter(value, path, conversion);
  });
}

}  // namespace vat::conversion
