#include "core/numerics/contact_limits.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

#include "core/laws/contact_damping.h"
#include "core/laws/friction.h"
#include "core/laws/lennard_jones.h"
#include "core/sampling/volumes.h"
#include "core/scene/interface_table.h"
#include "core/support/check.h"

namespace vat {
namespace {

/// The properties of a body that determine its contacts.
struct ContactBody {
  BodyKind kind;
  std::size_t material;
  Real mass;    ///< of a rigid body, or of the lightest free particle
  Real count;   ///< number of particles
  Real side;    ///< number of particles that can be in contact with another body at once
  Real radius;  ///< maximum radius
  Real pitch;   ///< distance between neighbouring particles
};

Real lightest_free(const SampledBody& body) {
  std::vector<bool> is_fixed(body.masses.size(), false);
  for (const Index fixed : body.fixed) is_fixed[fixed] = true;
  Real lightest = std::numeric_limits<Real>::infinity();
  for (std::size_t i = 0; i < body.masses.size(); ++i) {
    if (!is_fixed[i]) lightest = std::min(lightest, body.masses[i]);
  }
  return lightest;
}

ContactBody describe(const Scene& scene, const BodyDescription& body, const SampledBody& sample) {
  const bool is_rigid = body.kind == BodyKind::rigid;
  const auto count = static_cast<Real>(sample.positions.size());
  const bool is_sampled = !std::holds_alternative<ParticleShape>(body.shape);
  const bool is_empty = sample.radii.empty();  // a drained liquid
  return {body.kind,
          material_index(scene.materials, body.material),
          is_rigid ? std::accumulate(sample.masses.begin(), sample.masses.end(), Real{0})
                   : lightest_free(sample),
          count,
          is_rigid ? static_cast<Real>(count_flattest_side(sample, body.orientation)) : count,
          is_empty ? 0 : std::ranges::max(sample.radii),
          is_sampled || is_empty ? body.spacing : 2 * std::ranges::min(sample.radii)};
}

/// The number of particles of `other` within the reach of one particle. With a threshold of one
/// pitch, a particle between four others feels k sum (n.e)^2 = 2 k along the normal. For larger
/// thresholds, the number grows with the area in reach.
Real touched_by_one(const ContactBody& other, Real threshold) {
  const Real reach = std::max(Real{1}, threshold / other.pitch);
  return std::min(other.count, 2 * reach * reach);
}

/// The number of simultaneous contacts of `body`, or of one of its particles if it is not rigid.
Real load(const ContactBody& body, const ContactBody& other, Real threshold) {
  const Real each = touched_by_one(other, threshold);
  if (body.kind != BodyKind::rigid) return each;
  return std::min(body.side * each, other.side * touched_by_one(body, threshold));
}

/// A law of contact, and the pair of bodies that it limits most.
struct LawInUse {
  InterfaceConstants constants;
  Real threshold = 0;  ///< 0: the sum of the radii
  std::string path;

  Real inverse_mass = 0;               ///< maximum over all pairs of bodies [1/kg]
  std::array<std::size_t, 2> worst{};  ///< the bodies with this inverse mass
};

/// Adds a pair of bodies whose contacts act on an inertia of 1 / `inverse_mass`. Both indices are
/// equal for contacts of one body with itself or with the walls.
void take(LawInUse& law, Real inverse_mass, std::array<std::size_t, 2> pair) {
  if (inverse_mass <= law.inverse_mass) return;
  law.inverse_mass = inverse_mass;
  law.worst = pair;
}

/// Returns whether contacts can act. Two bodies of one liquid interact by SPH.
bool can_touch(const ContactBody& a, const ContactBody& b) {
  return a.kind != BodyKind::liquid || b.kind != BodyKind::liquid || a.material != b.material;
}

Real inverse_mass(const ContactBody& a, const ContactBody& b, const LawInUse& law) {
  const Real threshold = law.threshold > 0 ? law.threshold : a.radius + b.radius;
  return load(a, b, threshold) / a.mass + load(b, a, threshold) / b.mass;
}

/// The constants of the oscillation of a contact. A layer has its slope at half its rest distance,
/// which is closer than particles come. A projection has no oscillation.
InterfaceConstants oscillating_part(InterfaceConstants constants) {
  switch (constants.law) {
    case InterfaceLaw::penalty:
      break;
    case InterfaceLaw::lennard_jones:
      constants.stiffness =
          greatest_layer_slope(constants.stiffness, constants.reach - 1, constants.reach, 0.5);
      break;
    case InterfaceLaw::sph:
    case InterfaceLaw::projection:
      return {};
  }
  return constants;
}

/// The scene's interfaces, then the default one, then the self-contact of each material.
std::vector<LawInUse> list_laws(const Scene& scene) {
  std::vector<LawInUse> laws;
  for (std::size_t i = 0; i < scene.interfaces.size(); ++i) {
    const InterfaceDescription& interface = scene.interfaces[i];
    laws.push_back({oscillating_part(interface.constants), interface.threshold.value_or(0),
                    "/interfaces/" + std::to_string(i)});
  }
  laws.push_back({oscillating_part(scene.default_interface), 0, "/default_interface"});
  for (std::size_t m = 0; m < scene.materials.size(); ++m) {
    const SpringConstants own = scene.materials[m].self_contact.value_or(SpringConstants{});
    laws.push_back(
        {{own.stiffness, own.damping, 0}, 0, "/materials/" + std::to_string(m) + "/self_contact"});
  }
  return laws;
}

/// The laws with the bodies that each limits most.
std::vector<LawInUse> find_worst(const Scene& scene, const std::vector<ContactBody>& bodies) {
  const InterfaceTable table(scene.materials, scene.interfaces);
  const std::size_t other = scene.interfaces.size();
  std::vector<LawInUse> laws = list_laws(scene);
  const auto has_contacts = [&](const ContactBody& body) {
    return body.kind != BodyKind::liquid || !couples_liquids(scene.pressure_solver);
  };
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const ContactBody& a = bodies[i];
    if (!has_contacts(a)) continue;
    for (std::size_t j = 0; j < i; ++j) {
      const ContactBody& b = bodies[j];
      if (!scene.forces.contacts || !has_contacts(b) || !can_touch(a, b)) continue;
      LawInUse& law = laws[table.between(a.material, b.material).value_or(other)];
      take(law, inverse_mass(a, b, law), {j, i});
    }
    if (scene.vat && scene.forces.walls) {
      const Real at_once = a.kind == BodyKind::rigid ? a.side : 1;
      take(laws[table.with_walls(a.material).value_or(other)], at_once / a.mass, {i, i});
    }
    if (scene.forces.contacts && a.kind == BodyKind::deformable && a.count > 1) {
      LawInUse& law = laws[other + 1 + a.material];
      take(law, inverse_mass(a, a, law), {i, i});
    }
  }
  return laws;
}

/// The mean mass of a particle.
Real particle_mass(const ContactBody& body) {
  return body.kind == BodyKind::rigid ? body.mass / body.count : body.mass;
}

/// The larger one of the damping of a contact along its normal and that of friction across it [N
/// s/m].
Real greatest_damping(const LawInUse& law, const std::vector<ContactBody>& bodies) {
  const auto [first, second] = law.worst;
  const Real along = law.constants.restitution
                         ? damping_for(damping_ratio_for(*law.constants.restitution),
                                       law.constants.stiffness, law.inverse_mass)
                         : law.constants.damping;
  if (law.constants.friction == 0) return along;
  // A reduced mass is at most the lesser mass.
  const Real mass = std::min(particle_mass(bodies[first]), particle_mass(bodies[second]));
  return std::max(along, sticking_drag(law.constants.stiffness, mass));
}

/// Unit vectors in the axes of the body, one of each opposite pair.
std::array<Vec3, 13> lattice_directions() {
  std::array<Vec3, 13> directions;
  std::size_t count = 0;
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        if (9 * x + 3 * y + z > 0) directions[count++] = Vec3(x, y, z).normalized();
      }
    }
  }
  return directions;
}

Mat3 principal_axes(const SampledBody& body) {
  Vec3 center = Vec3::Zero();
  for (const Vec3& p : body.positions) center += p / static_cast<Real>(body.positions.size());
  Mat3 spread = Mat3::Zero();
  for (const Vec3& p : body.positions) spread += (p - center) * (p - center).transpose();
  return Eigen::SelfAdjointEigenSolver<Mat3>(spread).eigenvectors();
}

/// The number of particles in the foremost layer along `direction`.
std::size_t count_foremost(const SampledBody& body, const Vec3& direction) {
  constexpr Real kDepth = 0.1;  // in radii
  Real front = -std::numeric_limits<Real>::infinity();
  for (std::size_t i = 0; i < body.positions.size(); ++i) {
    front = std::max(front, direction.dot(body.positions[i]) + body.radii[i]);
  }
  std::size_t count = 0;
  for (std::size_t i = 0; i < body.positions.size(); ++i) {
    const Real behind = front - direction.dot(body.positions[i]) - body.radii[i];
    if (behind <= kDepth * body.radii[i]) ++count;
  }
  return count;
}

}  // namespace

std::size_t count_flattest_side(const SampledBody& body, const Quat& orientation) {
  VAT_CHECK(!body.positions.empty() && body.radii.size() == body.positions.size());
  const auto lattice = lattice_directions();
  std::vector<Vec3> directions(lattice.begin(), lattice.end());
  const Mat3 rotation = orientation.normalized().toRotationMatrix();
  for (Vec3& direction : directions) direction = rotation * direction;
  const Mat3 axes = principal_axes(body);
  directions.insert(directions.end(), {axes.col(0), axes.col(1), axes.col(2)});
  std::size_t most = 1;
  for (const Vec3& direction : directions) {
    most =
        std::max({most, count_foremost(body, direction), count_foremost(body, Vec3(-direction))});
  }
  return most;
}

void add_contact_limits(const Scene& scene, std::span<const SampledBody* const> samples,
                        std::vector<OscillatingPart>& parts) {
  VAT_CHECK(samples.size() == scene.bodies.size());
  std::vector<ContactBody> bodies;
  for (std::size_t b = 0; b < samples.size(); ++b) {
    bodies.push_back(describe(scene, scene.bodies[b], *samples[b]));
  }
  for (const LawInUse& law : find_worst(scene, bodies)) {
    if (law.inverse_mass == 0) continue;
    std::string names = '"' + scene.bodies[law.worst[0]].name + '"';
    if (law.worst[1] != law.worst[0]) names += " and \"" + scene.bodies[law.worst[1]].name + '"';
    parts.push_back({law.path,
                     "contacts of " + names + " may become unstable",
                     "undamped contacts gain energy with this integrator",
                     {law.constants.stiffness * law.inverse_mass,
                      greatest_damping(law, bodies) * law.inverse_mass},
                     {}});
  }
}

}  // namespace vat
