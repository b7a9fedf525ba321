#include "protocol/scene/level.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/limits.h"

namespace vat {
namespace {

/// The separator of the name and the level of a scene.
constexpr char kSeparator = '@';

/// Factors of constants by particle and by pair, at the factor f of the distance of particles, in d
/// dimensions. A solid then keeps its stiffness and its overlap relative to this distance: the
/// number of particles of a surface is proportional to f^(1 - d), and their mass to f^d.
struct Factors {
  Real length = 1;           ///< f
  Real stiffness = 1;        ///< of springs and contacts: f^(d - 2)
  Real spring_damping = 1;   ///< f^(d - 2), as the stiffness of a continuum
  Real contact_damping = 1;  ///< f^(d - 1), with a constant ratio to the critical damping
};

Factors factors_of(Real f, int dimensions) {
  return {f, std::pow(f, dimensions - 2), std::pow(f, dimensions - 2), std::pow(f, dimensions - 1)};
}

/// Returns the error of the first body whose particles do not follow from its shape.
std::optional<Error> find_given_particles(const Scene& scene) {
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const BodyDescription& body = scene.bodies[b];
    const std::string path = "/bodies/" + std::to_string(b);
    if (std::holds_alternative<ParticleShape>(body.shape)) {
      return Error{"not_scalable", path + "/shape/type",
                   "must not be \"particles\" at a level other than normal"};
    }
    if (!body.springs.empty()) {
      return Error{"not_scalable", path + "/springs",
                   "must be left out at a level other than normal, since they join particles"};
    }
  }
  return {};
}

void scale(std::optional<SpringConstants>& constants, Real stiffness, Real damping) {
  if (!constants) return;
  constants->stiffness *= stiffness;
  constants->damping *= damping;
}

void scale(Material& material, const Factors& by) {
  if (material.liquid) material.liquid->support_radius *= by.length;
  if (material.springs) {
    auto& [structural, shear, bend] = *material.springs;
    for (auto* constants : {&structural, &shear, &bend}) {
      scale(*constants, by.stiffness, by.spring_damping);
    }
  }
  scale(material.self_contact, by.stiffness, by.contact_damping);
}

void scale(InterfaceConstants& constants, const Factors& by) {
  constants.stiffness *= by.stiffness;
  constants.damping *= by.contact_damping;
}

/// A tick has a whole number of steps.
void scale(Numerics& numerics, Real f) {
  if (numerics.accuracy) return;  // the step follows from it
  const Real steps = std::ceil(numerics.tick / (f * numerics.step) - 1e-9);
  numerics.step = numerics.tick / std::max(Real{1}, steps);
}

/// The number of particles in the same volume.
std::size_t scaled_count(std::size_t count, Real f, int dimensions) {
  const Real scaled = std::ceil(static_cast<Real>(count) / std::pow(f, dimensions));
  return std::min(kMaxParticles, static_cast<std::size_t>(scaled));
}

}  // namespace

Real spacing_factor(Level level) {
  // In three dimensions, the numbers of particles are 0.3, 1, 2.4 and 8 times that of normal.
  constexpr std::array<Real, kLevelCount> kFactors{1.5, 1, 0.75, 0.5};
  return kFactors[static_cast<std::size_t>(level)];
}

Result<Scene> at_level(Scene scene, Level level) {
  if (level == Level::normal) return scene;
  if (auto error = find_given_particles(scene)) return *std::move(error);
  std::string name = scene.name + kSeparator + to_string(level);
  if (name.size() > kMaxNameLength) {
    return Error{"too_long", "/name", "must have at most 56 bytes at a level other than normal"};
  }
  const Real f = spacing_factor(level);
  const Factors by = factors_of(f, scene.dimensions);
  for (Material& material : scene.materials) scale(material, by);
  scale(scene.default_interface, by);
  for (InterfaceDescription& interface : scene.interfaces) {
    scale(interface.constants, by);
    if (interface.threshold) *interface.threshold *= f;
  }
  for (BodyDescription& body : scene.bodies) {
    body.spacing *= f;
    if (body.radius) *body.radius *= f;
  }
  for (Emitter& emitter : scene.emitters) {
    emitter.most_particles = scaled_count(emitter.most_particles, f, scene.dimensions);
  }
  scale(scene.numerics, f);
  scene.name = std::move(name);
  return scene;
}

LevelledName split_level(std::string_view name) {
  const std::size_t at = name.rfind(kSeparator);
  if (at == std::string_view::npos) return {name, Level::normal};
  const std::optional<Level> level = find_level(name.substr(at + 1));
  if (!level || *level == Level::normal) return {name, Level::normal};
  return {name.substr(0, at), *level};
}

std::optional<Level> find_level(std::string_view name) {
  const auto found = std::ranges::find(kNamesOf<Level>, name);
  if (found == kNamesOf<Level>.end()) return {};
  return static_cast<Level>(found - kNamesOf<Level>.begin());
}

}  // namespace vat
