#include "core/scene/material_members.h"
#include "protocol/scene/appearance.h"
#include "protocol/scene/scene_json.h"

namespace vat {
namespace {

using vat::to_json;

Json to_json(const std::vector<Vec3>& vectors) {
  Json list = Json::array();
  for (const Vec3& v : vectors) list.push_back(to_json(v));
  return list;
}

template <class Part>
Json members_of(const Part& part) {
  Json json = Json::object();
  for (const Member<Part>& member : kMembersOf<Part>) {
    if (const auto* flag = std::get_if<bool Part::*>(&member.value))
      json[member.name] = part.**flag;
    if (const auto number = member.number_in(part)) json[member.name] = *number;
  }
  return json;
}

Json to_json(const SpringConstants& constants) {
  return members_of(constants);
}

Json to_json(const LatticeSprings& springs) {
  Json json = Json::object();
  if (springs.structural) json["structural"] = to_json(*springs.structural);
  if (springs.shear) json["shear"] = to_json(*springs.shear);
  if (springs.bend) json["bend"] = to_json(*springs.bend);
  return json;
}

Json to_json(const Material& material) {
  Json json = members_of(material);
  json["name"] = material.name;
  if (material.liquid) json["liquid"] = members_of(*material.liquid);
  if (material.springs) json["springs"] = to_json(*material.springs);
  if (material.self_contact) json["self_contact"] = to_json(*material.self_contact);
  if (material.plasticity) json["plasticity"] = members_of(*material.plasticity);
  Json appearance = write_appearance(material.appearance);
  if (!appearance.empty()) json["appearance"] = std::move(appearance);
  return json;
}

Json to_json(const InterfaceConstants& constants) {
  const bool is_penalty = constants.law == InterfaceLaw::penalty;
  const bool is_layer = constants.law == InterfaceLaw::lennard_jones;
  Json json = Json::object();
  if (!is_penalty) json["law"] = to_string(constants.law);
  if (is_penalty || is_layer) json["stiffness"] = constants.stiffness;
  if (is_penalty && !constants.restitution) json["damping"] = constants.damping;
  if (is_layer) json["reach"] = constants.reach;
  if (is_penalty || constants.law == InterfaceLaw::projection) {
    json["friction"] = constants.friction;
    if (constants.restitution) json["restitution"] = *constants.restitution;
  }
  return json;
}

Json to_json(const InterfaceDescription& interface) {
  Json json = to_json(interface.constants);
  json["materials"] = interface.materials;
  json["contact_angle"] = interface.contact_angle;
  const bool is_sph = interface.constants.law == InterfaceLaw::sph;
  if (interface.threshold && !is_sph) json["threshold"] = *interface.threshold;
  return json;
}

Json to_json(const std::array<Wall, 6>& walls) {
  Json json;
  for (std::size_t i = 0; i < walls.size(); ++i) {
    json[kWallNames[i]] = {{"no_slip", walls[i].no_slip}, {"velocity", to_json(walls[i].velocity)}};
  }
  return json;
}

Json to_json(const SlideMotion& motion) {
  return {{"type", "slide"},
          {"axis", to_json(motion.axis)},
          {"stroke", motion.stroke},
          {"period", motion.period}};
}

Json to_json(const Vat& vat) {
  Json json = {{"min", to_json(vat.min)},
               {"max", to_json(vat.max)},
               {"lid", vat.lid},
               {"walls", to_json(vat.walls)}};
  if (vat.motion) json["motion"] = to_json(*vat.motion);
  return json;
}

Json to_json(const Periodicity& periodic) {
  Json axes = Json::array();
  for (std::size_t axis = 0; axis < periodic.axes.size(); ++axis) {
    if (periodic.axes[axis]) axes.push_back(kAxisNames[axis]);
  }
  return {
      {"axes", std::move(axes)}, {"min", to_json(periodic.min)}, {"max", to_json(periodic.max)}};
}

Json to_json(const ForceSwitches& forces) {
  return {{"gravity", forces.gravity},     {"pressure", forces.pressure},
          {"viscosity", forces.viscosity}, {"springs", forces.springs},
          {"contacts", forces.contacts},   {"walls", forces.walls}};
}

Json to_json(const Numerics& numerics) {
  Json json{{"tick", numerics.tick}};
  if (numerics.accuracy) {
    json["accuracy"] = *numerics.accuracy;
  } else {
    json["integrator"] = to_string(numerics.integrator);
    json["step"] = numerics.step;
    json["control"] = to_string(numerics.control);
    json["tolerance"] = numerics.tolerance;
  }
  if (numerics.device) json["device"] = to_text(*numerics.device);
  return json;
}

Json to_json(const VectorField& field) {
  Json waves = Json::array();
  for (const PlaneWave& wave : field.waves) {
    waves.push_back({{"amplitude", to_json(wave.amplitude)},
                     {"wave_vector", to_json(wave.wave_vector)},
                     {"phase", wave.phase}});
  }
  Json gradient = Json::array();
  for (Eigen::Index row = 0; row < 3; ++row) {
    gradient.push_back(to_json(Vec3(field.gradient.row(row).transpose())));
  }
  return {{"center", to_json(field.center)},
          {"gradient", std::move(gradient)},
          {"waves", std::move(waves)}};
}

Json to_json(const BoxShape& box) {
  return {{"type", "box"}, {"center", to_json(box.center)}, {"size", to_json(box.size)}};
}

Json to_json(const SphereShape& sphere) {
  return {{"type", "sphere"}, {"center", to_json(sphere.center)}, {"radius", sphere.radius}};
}

Json to_json(const CylinderShape& cylinder) {
  return {{"type", "cylinder"},
          {"center", to_json(cylinder.center)},
          {"axis", to_json(cylinder.axis)},
          {"radius", cylinder.radius},
          {"height", cylinder.height}};
}

Json to_json(const MeshShape& mesh) {
  return {{"type", "mesh"},
          {"source", mesh.source},
          {"vertices", to_json(mesh.vertices)},
          {"triangles", mesh.triangles}};
}

Json to_json(const ParticleShape& particles) {
  Json json = {{"type", "particles"}, {"positions", to_json(particles.positions)}};
  if (!particles.velocities.empty()) json["velocities"] = to_json(particles.velocities);
  if (!particles.masses.empty()) json["masses"] = particles.masses;
  if (!particles.radii.empty()) json["radii"] = particles.radii;
  if (!particles.fixed.empty()) json["fixed"] = particles.fixed;
  return json;
}

Json to_json(const SpringDescription& spring) {
  Json json = to_json(spring.constants);
  json["particles"] = {spring.a, spring.b};
  if (spring.rest_length) json["rest_length"] = *spring.rest_length;
  return json;
}

Json to_json(const BodyDescription& body) {
  Json json = {{"name", body.name},
               {"kind", to_string(body.kind)},
               {"material", body.material},
               {"shape", write_shape(body.shape)},
               {"position", to_json(body.position)},
               {"orientation", Json::array({body.orientation.w(), body.orientation.x(),
                                            body.orientation.y(), body.orientation.z()})},
               {"velocity", to_json(body.velocity)},
               {"angular_velocity", to_json(body.angular_velocity)},
               {"jitter", body.jitter},
               {"seed", body.seed},
               {"fixed", body.fixed},
               {"release", body.release},
               {"sub_steps", body.sub_steps}};
  // A spacing of zero means that explicit particles have no spacing.
  if (body.spacing != 0) json["spacing"] = body.spacing;
  if (body.mass) json["mass"] = *body.mass;
  if (body.radius) json["radius"] = *body.radius;
  for (const SpringDescription& spring : body.springs) json["springs"].push_back(to_json(spring));
  if (body.melting) json["melting"] = {{"into", body.melting->into}, {"at", body.melting->at}};
  if (body.motion) json["motion"] = to_json(*body.motion);
  if (body.axle) {
    json["axle"] = {{"direction", to_json(body.axle->direction)}, {"damping", body.axle->damping}};
  }
  if (body.velocity_field) json["velocity_field"] = to_json(*body.velocity_field);
  if (body.displacement_field) json["displacement_field"] = to_json(*body.displacement_field);
  return json;
}

Json to_json(const Emitter& emitter) {
  Json json = {{"name", emitter.name},
               {"body", emitter.body},
               {"position", to_json(emitter.position)},
               {"direction", to_json(emitter.direction)},
               {"speed", emitter.speed},
               {"from", emitter.from},
               {"until", emitter.until},
               {"most_particles", emitter.most_particles},
               {"open", emitter.open}};
  if (emitter.radius) json["radius"] = *emitter.radius;
  if (emitter.size) json["size"] = *emitter.size;
  return json;
}

Json to_json(const Drain& drain) {
  return {{"name", drain.name}, {"min", to_json(drain.min)}, {"max", to_json(drain.max)}};
}

Json to_json(const IncompressibleSolve& solve) {
  return {{"density_tolerance", solve.density_tolerance},
          {"divergence_tolerance", solve.divergence_tolerance},
          {"most_iterations", static_cast<unsigned>(solve.most_iterations)}};
}

template <class T>
Json to_list(const std::vector<T>& values) {
  Json list = Json::array();
  for (const T& value : values) list.push_back(to_json(value));
  return list;
}

}  // namespace

Json write_shape(const Shape& shape) {
  return std::visit([](const auto& s) { return to_json(s); }, shape);
}

Json write_scene(const Scene& scene) {
  Json json = {{"format", "vat.scene/1"},
               {"name", scene.name},
               {"title", scene.title},
               {"description", scene.description},
               {"gravity", to_json(scene.gravity)},
               {"materials", to_list(scene.materials)},
               {"default_interface", to_json(scene.default_interface)},
               {"interfaces", to_list(scene.interfaces)},
               {"dimensions", static_cast<unsigned>(scene.dimensions)},
               {"pressure_solver", to_string(scene.pressure_solver)},
               {"printed_pressure_force", scene.printed_pressure_force},
               {"kernel", to_string(scene.kernel)},
               {"pair_precision", to_string(scene.pair_precision)},
               {"surface_tension_model", to_string(scene.surface_model)},
               {"incompressible", to_json(scene.incompressible)},
               {"forces", to_json(scene.forces)},
               {"numerics", to_json(scene.numerics)},
               {"bodies", to_list(scene.bodies)}};
  if (!scene.emitters.empty()) json["emitters"] = to_list(scene.emitters);
  if (!scene.drains.empty()) json["drains"] = to_list(scene.drains);
  if (scene.vat) json["vat"] = to_json(*scene.vat);
  if (scene.periodic) json["periodic"] = to_json(*scene.periodic);
  if (scene.central_field) {
    json["central_field"] = {{"center", to_json(scene.central_field->center)},
                             {"angular_frequency", scene.central_field->angular_frequency}};
  }
  if (scene.settling) {
    json["settling"] = {{"drag", scene.settling->drag}, {"until", scene.settling->until}};
  }
  if (scene.sleeping) {
    json["sleeping"] = {{"speed", scene.sleeping->speed}, {"after", scene.sleeping->after}};
  }
  return json;
}

}  // namespace vat
