#include <algorithm>
#include <set>
#include <utility>

#include "core/limits.h"
#include "core/validation/validate_parts.h"

namespace vat {
namespace {

bool is_known(const Scene& scene, const std::string& material) {
  return material == kVatMaterial ||
         std::ranges::find(scene.materials, material, &Material::name) != scene.materials.end();
}

bool joins(const InterfaceDescription& interface, const std::string& material) {
  return interface.materials[0] == material || interface.materials[1] == material;
}

void check_interface_constants(const InterfaceConstants& constants, const std::string& path,
                               RangeCheck& check) {
  check_members(constants.spring(), path, check);
  check.real(constants.friction, 0, kMaxFriction, path + "/friction");
  check.real(constants.reach, kMinLayerReach, kMaxLayerReach, path + "/reach");
  if (!constants.restitution) return;
  const bool is_penalty = constants.law == InterfaceLaw::penalty;
  check.real(*constants.restitution, is_penalty ? kMinRestitution : 0, 1, path + "/restitution");
  if (constants.damping != 0) {
    check.add("not_allowed", path + "/damping", "must be left out beside a restitution");
  }
}

/// Checks the contact angle. With cohesion, below 30 degrees a drop becomes a film one or two
/// particles thick, and above 135 the attraction by the wall exceeds the repulsion. With curvature,
/// below 75 degrees the contact line advances as a film one particle thick, and above 150 the drop
/// does not come to rest.
void check_contact_angle(const Scene& scene, const InterfaceDescription& interface,
                         const std::string& path, RangeCheck& check) {
  if (scene.surface_model == SurfaceModel::cohesion) {
    check.real(interface.contact_angle, kMinContactAngle, kMaxContactAngle, path);
    return;
  }
  if (interface.contact_angle != kNeutralAngle && !joins(interface, kVatMaterial)) {
    check.add("not_allowed", path,
              "must be left out: with the model \"curvature\" it is for interfaces with \"vat\"");
    return;
  }
  check.real(interface.contact_angle, 75, 150, path);
}

/// Checks the threshold against the coarsest spacing of the sampled bodies at this interface.
/// Explicit particles may have any distance.
void check_threshold(const Scene& scene, const InterfaceDescription& interface,
                     const std::string& path, RangeCheck& check) {
  if (!check.real(*interface.threshold, kMinLength, kMaxLength, path)) return;
  Real spacing = 0;
  for (const BodyDescription& body : scene.bodies) {
    if (!joins(interface, body.material)) continue;
    if (std::holds_alternative<ParticleShape>(body.shape)) return;
    spacing = std::max(spacing, body.spacing);
  }
  if (spacing > 0) {
    check.real(*interface.threshold, kMinLength, kMaxReachInSpacings * spacing, path);
  }
}

std::size_t count_solids(const Scene& scene, const std::string& material) {
  return static_cast<std::size_t>(
      std::ranges::count_if(scene.bodies, [&](const BodyDescription& body) {
        return body.kind != BodyKind::liquid && body.material == material;
      }));
}

/// Returns whether the interface joins two bodies that are not liquid.
bool joins_solids(const Scene& scene, const InterfaceDescription& interface) {
  const auto& [first, second] = interface.materials;
  if (first == second) return count_solids(scene, first) > 1;
  const auto is_solid = [&](const std::string& material) {
    return material == kVatMaterial || count_solids(scene, material) > 0;
  };
  return is_solid(first) && is_solid(second);
}

}  // namespace

void check_interface(const Scene& scene, const InterfaceDescription& interface,
                     const std::string& path, RangeCheck& check) {
  for (std::size_t side = 0; side < 2; ++side) {
    if (is_known(scene, interface.materials[side])) continue;
    check.add_unknown(path + "/materials/" + std::to_string(side),
                      "must be \"vat\" or the name of one of the scene's materials",
                      interface.materials[side], scene.materials, &Material::name);
  }
  if (interface.materials[0] == kVatMaterial && interface.materials[1] == kVatMaterial) {
    check.add("unknown_name", path + "/materials", "must name at least one of the materials");
  }
  check_interface_constants(interface.constants, path, check);
  check_contact_angle(scene, interface, path + "/contact_angle", check);
  if (interface.threshold) {
    check_threshold(scene, interface, path + "/threshold", check);
  }
  if (interface.constants.law != InterfaceLaw::sph) return;
  if (scene.pressure_solver == PressureSolver::gas) {
    check.add("not_allowed", path + "/law",
              "\"sph\" needs the pressure solver \"tait\": in \"gas\" solids have no density");
  } else if (joins_solids(scene, interface)) {
    check.add("not_allowed", path + "/law",
              "\"sph\" is for liquids, but the interface joins bodies that are not liquid");
  }
}

void check_interfaces(const Scene& scene, RangeCheck& check) {
  check_interface_constants(scene.default_interface, "/default_interface", check);
  if (scene.default_interface.law == InterfaceLaw::sph) {
    check.add("not_allowed", "/default_interface/law",
              "must not be \"sph\", which is for a liquid and another material");
  }
  std::set<std::pair<std::string, std::string>> pairs;
  for (std::size_t i = 0; i < scene.interfaces.size(); ++i) {
    const std::string path = "/interfaces/" + std::to_string(i);
    check_interface(scene, scene.interfaces[i], path, check);
    const auto& [first, second] = scene.interfaces[i].materials;
    if (!pairs.insert(std::minmax(first, second)).second) {
      check.add("duplicate", path + "/materials", "must not repeat an earlier pair");
    }
  }
}

void check_new_solid(const Scene& scene, const BodyDescription& body, const std::string& path,
                     RangeCheck& check) {
  if (body.kind == BodyKind::liquid) return;
  Scene with_body;
  with_body.bodies = scene.bodies;
  with_body.bodies.push_back(body);
  for (const InterfaceDescription& interface : scene.interfaces) {
    if (interface.constants.law != InterfaceLaw::sph || !joins(interface, body.material)) continue;
    if (!joins_solids(with_body, interface)) continue;
    check.add("not_allowed", path + "/material",
              "must not join solid bodies by an interface with the law \"sph\"");
  }
}

void check_law_numerics(const Numerics& numerics, const InterfaceConstants& constants,
                        const std::string& path, RangeCheck& check) {
  if (constants.law == InterfaceLaw::penalty && constants.restitution &&
      numerics.control == StepControl::local) {
    check.add("not_allowed", path + "/restitution", "needs fixed or adaptive steps");
  }
  if (constants.law != InterfaceLaw::projection) return;
  if (numerics.control == StepControl::local) {
    check.add("not_allowed", path + "/law", "\"projection\" needs fixed or adaptive steps");
  }
  if (numerics.integrator != IntegratorId::velocity_verlet &&
      numerics.integrator != IntegratorId::symplectic_euler) {
    check.add("not_allowed", path + "/law",
              "\"projection\" needs the integrator \"velocity_verlet\" or \"symplectic_euler\"");
  }
}

}  // namespace vat
