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
  liquid.artificial_viscosity =
      reader.real("artificial_viscosity", 0, kMaxArtificialViscosity, liquid.artificial_viscosity);
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

InterfaceConstants to_interface_constants(ObjectReader& reader) {
  const SpringConstants spring = to_spring_constants(reader);
  return {spring.stiffness, spring.damping, reader.real("friction", kAnyMin, kAnyMax, 0)};
}

InterfaceConstants to_interface_constants(const Json& value, std::string path, Errors& errors) {
  ObjectReader reader(value, std::move(path), errors);
  const InterfaceConstants constants = to_interface_constants(reader);
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
  interface.constants = to_interface_constants(reader);
  if (reader.has("threshold")) interface.threshold = reader.real("threshold", 0, kMaxLength);
  reader.refuse_unknown();
  return interface;
}

}  // namespace vat::scene_parts
