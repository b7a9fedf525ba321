#include "protocol/scene/scene_parts.h"

#include <algorithm>
#include <initializer_list>

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
  liquid.surface_tension = reader.real("surface_tension", 0, kMaxSurfaceTension, 0);
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

Plasticity to_plasticity(const Json& value, std::string path, Errors& errors) {
  ObjectReader reader(value, std::move(path), errors);
  Plasticity plasticity;
  plasticity.yield_strain = reader.real("yield_strain", kAnyMin, kAnyMax);
  plasticity.hardening = reader.real("hardening", kAnyMin, kAnyMax, plasticity.hardening);
  plasticity.relaxation_time =
      reader.real("relaxation_time", kAnyMin, kAnyMax, plasticity.relaxation_time);
  plasticity.max_strain = reader.real("max_strain", kAnyMin, kAnyMax, plasticity.max_strain);
  reader.refuse_unknown();
  return plasticity;
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

namespace {

using Laws = std::initializer_list<InterfaceLaw>;
using enum InterfaceLaw;

/// The law of an interface, and the members that only some laws have.
class LawReader {
 public:
  LawReader(ObjectReader& reader, Errors& errors) : reader_(reader), errors_(errors) {
    const std::size_t errors_before = errors.size();
    // The order of InterfaceLaw.
    law_ = static_cast<InterfaceLaw>(
        reader.choice("law", {"penalty", "lennard_jones", "sph", "projection"}, std::size_t{0}));
    is_known_ = errors.size() == errors_before;
  }

  InterfaceLaw law() const { return law_; }
  bool is_one_of(Laws laws) const { return std::ranges::find(laws, law_) != laws.end(); }
  bool needs(Laws laws) const { return is_known_ && is_one_of(laws); }
  /// Returns the member if it is present. Adds an error if the law does not have it.
  std::optional<Real> real(std::string_view key, Laws laws) {
    if (!reader_.has(key)) return {};
    if (is_known_ && !is_one_of(laws)) {
      add_error(errors_, "not_allowed", reader_.path_of(key),
                "is not for the law \"" + std::string(to_string(law_)) + '"');
    }
    return reader_.real(key, kAnyMin, kAnyMax);
  }

 private:
  ObjectReader& reader_;
  Errors& errors_;
  InterfaceLaw law_;
  bool is_known_;
};

InterfaceConstants to_interface_constants(LawReader& law, ObjectReader& reader) {
  InterfaceConstants constants;
  constants.law = law.law();
  constants.stiffness = law.needs({penalty, lennard_jones})
                            ? reader.real("stiffness", 0, kMaxStiffness)
                            : law.real("stiffness", {}).value_or(0);
  constants.damping = law.real("damping", {penalty}).value_or(0);
  constants.restitution = law.real("restitution", {penalty, projection});
  constants.friction = law.real("friction", {penalty, projection}).value_or(0);
  constants.reach = law.real("reach", {lennard_jones}).value_or(constants.reach);
  return constants;
}

}  // namespace

InterfaceConstants to_interface_constants(const Json& value, std::string path, Errors& errors) {
  ObjectReader reader(value, std::move(path), errors);
  LawReader law(reader, errors);
  const InterfaceConstants constants = to_interface_constants(law, reader);
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
  material.implicit_springs = reader.boolean("implicit_springs", material.implicit_springs);
  if (const Json* plasticity = reader.member("plasticity")) {
    material.plasticity = to_plasticity(*plasticity, reader.path_of("plasticity"), errors);
  }
  if (reader.has("tearing_strain")) {
    material.tearing_strain = reader.real("tearing_strain", kAnyMin, kAnyMax);
  }
  if (reader.has("elongation_limit")) {
    material.elongation_limit = reader.real("elongation_limit", kAnyMin, kAnyMax);
  }
  material.bulk_modulus = reader.real("bulk_modulus", kAnyMin, kAnyMax, material.bulk_modulus);
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
  LawReader law(reader, errors);
  interface.constants = to_interface_constants(law, reader);
  interface.threshold = law.real("threshold", {penalty, lennard_jones, projection});
  interface.contact_angle = reader.real("contact_angle", kAnyMin, kAnyMax, interface.contact_angle);
  reader.refuse_unknown();
  return interface;
}

}  // namespace vat::scene_parts
