#include "protocol/scene/scene_parts.h"

#include <algorithm>
#include <initializer_list>

#include "core/limits.h"
#include "core/scene/material_members.h"
#include "protocol/scene/appearance.h"

namespace vat::scene_parts {
namespace {

template <class Part>
void read_members(ObjectReader& reader, Part& part) {
  for (const Member<Part>& member : kMembersOf<Part>) {
    if (const auto* flag = std::get_if<bool Part::*>(&member.value)) {
      part.** flag = reader.boolean(member.name, part.**flag);
    } else if (const auto* real = std::get_if<Real Part::*>(&member.value)) {
      const std::optional<Real> fallback =
          member.is_required ? std::nullopt : std::optional(part.**real);
      part.** real = reader.real(member.name, member.min, member.max, fallback);
    } else if (reader.has(member.name)) {
      part.**std::get_if<std::optional<Real> Part::*>(&member.value) =
          reader.real(member.name, member.min, member.max);
    }
  }
}

/// Reads a part of a material that has numbers only.
template <class Part>
Part to_part(const Json& value, std::string path, Errors& errors) {
  ObjectReader reader(value, std::move(path), errors);
  Part part;
  read_members(reader, part);
  reader.refuse_unknown();
  return part;
}

LatticeSprings to_lattice_springs(const Json& value, std::string path, Errors& errors) {
  ObjectReader reader(value, std::move(path), errors);
  LatticeSprings springs;
  read_member(reader, "structural", springs.structural, errors, to_part<SpringConstants>);
  read_member(reader, "shear", springs.shear, errors, to_part<SpringConstants>);
  read_member(reader, "bend", springs.bend, errors, to_part<SpringConstants>);
  reader.refuse_unknown();
  return springs;
}

}  // namespace

SpringConstants to_spring_constants(ObjectReader& reader) {
  SpringConstants constants;
  read_members(reader, constants);
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
    law_ = read_enum<InterfaceLaw>(reader, "law", InterfaceLaw::penalty);
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
  read_members(reader, material);
  read_member(reader, "liquid", material.liquid, errors, to_part<LiquidConstants>);
  read_member(reader, "springs", material.springs, errors, to_lattice_springs);
  read_member(reader, "self_contact", material.self_contact, errors, to_part<SpringConstants>);
  read_member(reader, "plasticity", material.plasticity, errors, to_part<Plasticity>);
  read_member(reader, "appearance", material.appearance, errors, to_appearance);
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
