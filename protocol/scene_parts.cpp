#include "protocol/scene_parts.h"

#include "core/limits.h"

namespace vat::scene_parts {
namespace {

LiquidConstants to_liquid(const Json& value, std::string path, Errors& errors) {
  ObjectReader reader(value, std::move(path), errors);
  LiquidConstants liquid;
  liquid.stiffness = reader.real("stiffness", 0, kMaxStiffness);
  liquid.viscosity = reader.real("viscosity", kAnyMin, kAnyMax);
  liquid.support_radius = reader.real("support_radius", kMinLength, kMaxLength);
  reader.refuse_unknown();
  return liquid;
}

LatticeSprings to_lattice_springs(const Json& value, std::string path, Errors& errors) {
  ObjectReader reader(value, std::move(path), errors);
  LatticeSprings springs;
  const auto read = [&](std::string_view key, std::optional<SpringConstants>& constants) {
    if (const Json* member = reader.member(key)) {
      constants = to_spring_constants(*member, reader.path_of(key), errors);
    }
  };
  read("structural", springs.structural);
  read("shear", springs.shear);
  read("bend", springs.bend);
  reader.refuse_unknown();
  return springs;
}

SlideMotion to_motion(const Json& value, std::string path, Errors& errors) {
  ObjectReader reader(value, std::move(path), errors);
  reader.choice("type", {"slide"});
  SlideMotion motion;
  motion.axis = reader.vector("axis", -kMaxLength, kMaxLength, motion.axis);
  motion.stroke = reader.real("stroke", -kMaxLength, kMaxLength);
  motion.period = reader.real("period", kAnyMin, kAnyMax, motion.period);
  reader.refuse_unknown();
  return motion;
}

}  // namespace

SpringConstants to_spring_constants(ObjectReader& reader) {
  SpringConstants constants;
  constants.stiffness = reader.real("stiffness", 0, kMaxStiffness);
  constants.damping = reader.real("damping", kAnyMin, kAnyMax, constants.damping);
  return constants;
}

SpringConstants to_spring_constants(const Json& value, std::string path, Errors& errors) {
  ObjectReader reader(value, std::move(path), errors);
  const SpringConstants constants = to_spring_constants(reader);
  reader.refuse_unknown();
  return constants;
}

Material to_material(const Json& value, std::string path, Errors& errors) {
  ObjectReader reader(value, std::move(path), errors);
  Material material;
  material.name = reader.text("name", kMaxNameLength);
  material.density = reader.real("density", kAnyMin, kAnyMax, material.density);
  if (const Json* liquid = reader.member("liquid")) {
    material.liquid = to_liquid(*liquid, reader.path_of("liquid"), errors);
  }
  if (const Json* springs = reader.member("springs")) {
    material.springs = to_lattice_springs(*springs, reader.path_of("springs"), errors);
  }
  if (const Json* contact = reader.member("self_contact")) {
    material.self_contact = to_spring_constants(*contact, reader.path_of("self_contact"), errors);
  }
  reader.refuse_unknown();
  return material;
}

InterfaceDescription to_interface(const Json& value, std::string path, Errors& errors) {
  ObjectReader reader(value, std::move(path), errors);
  InterfaceDescription interface;
  if (const Json* names = reader.member("materials", true)) {
    const std::string names_path = reader.path_of("materials");
    if (to_array(*names, names_path, 2, 2, errors) != nullptr) {
      for (std::size_t side = 0; side < 2; ++side) {
        const auto name =
            to_text((*names)[side], pointer_to(names_path, side), kMaxNameLength, errors);
        interface.materials[side] = name.value_or("");
      }
    }
  }
  interface.constants = to_spring_constants(reader);
  if (reader.has("threshold")) interface.threshold = reader.real("threshold", 0, kMaxLength);
  reader.refuse_unknown();
  return interface;
}

Vat to_vat(const Json& value, std::string path, Errors& errors) {
  ObjectReader reader(value, std::move(path), errors);
  Vat vat;
  vat.min = reader.vector("min", -kMaxLength, kMaxLength);
  vat.max = reader.vector("max", -kMaxLength, kMaxLength);
  vat.lid = reader.boolean("lid", vat.lid);
  if (const Json* motion = reader.member("motion")) {
    vat.motion = to_motion(*motion, reader.path_of("motion"), errors);
  }
  reader.refuse_unknown();
  return vat;
}

Numerics to_numerics(const Json& value, std::string path, Errors& errors) {
  ObjectReader reader(value, std::move(path), errors);
  Numerics numerics;
  // In the order of IntegratorId.
  numerics.integrator = static_cast<IntegratorId>(reader.choice(
      "integrator",
      {"explicit_euler", "symplectic_euler", "velocity_verlet", "heun", "runge_kutta_4"},
      static_cast<std::size_t>(numerics.integrator)));
  numerics.step = reader.real("step", kMinStep, kMaxStep, numerics.step);
  numerics.tick = reader.real("tick", kMinStep, kMaxTick, numerics.tick);
  reader.refuse_unknown();
  return numerics;
}

}  // namespace vat::scene_parts
