#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "core/laws/friction.h"
#include "core/model/model.h"

namespace vat {

/// A contact (dynamic connection, Boldt def. 0.2) of particle `self` with particle `other`.
struct Contact {
  Index self = 0;
  Index other = 0;
  Vec3 x;              ///< position of self minus position of other [m]
  Real distance;       ///< |x| [m]
  Real threshold;      ///< the contact acts below this distance; rest length of its spring [m]
  Real stiffness;      ///< [N/m]
  Real damping;        ///< [N s/m]
  Real damping_ratio;  ///< for a coefficient of restitution; replaces `damping` if above 0
  /// width of the attractive range of an adhesive contact [m]; 0: no attraction (spring contact)
  Real layer;
};

/// The laws of the contacts of a particle i with other particles. Two particles of one rigid body
/// have no contact. An excluded pair of particles of a deformable body, or of their periodic
/// images, has no contact either. There are no contacts between liquid particles of one material,
/// which interact by SPH.
class ContactRules {
 public:
  ContactRules(const Model& model, Index i)
      : model_(model), i_(i), body_(model.body[i]), material_(model.material[i]) {}

  /// Returns whether there is a contact law for particles i and j. If so, sets the threshold and
  /// the constants of `contact`, but not its geometry.
  bool find_law(Index j, Contact& contact) const {
    if (model_.body[j] == body_) return find_self_law(j, contact);
    const ContactLaw& law = model_.contact_law(material_, model_.material[j]);
    const Real touching = law.threshold > 0 ? law.threshold : model_.radius[i_] + model_.radius[j];
    contact.layer = law.layer * touching;
    contact.threshold = touching + contact.layer;
    contact.stiffness = law.stiffness;
    contact.damping = law.damping;
    contact.damping_ratio = law.damping_ratio;
    return true;
  }

  /// Returns whether the pair of particles i and j is excluded from contacts. Intended for near
  /// pairs only, because of the cost of a binary search.
  bool excluded(Index j) const {
    if (model_.body[j] != body_) return false;
    const auto begin = model_.exclusions.begin();
    return std::binary_search(begin + model_.exclusion_begin[i_],
                              begin + model_.exclusion_begin[i_ + 1], j);
  }

 private:
  bool find_self_law(Index j, Contact& contact) const {
    if (i_ == j || model_.bodies[body_].kind != BodyKind::deformable) return false;
    const std::optional<SpringConstants>& law = model_.self_contacts[material_];
    if (!law) return false;
    contact.threshold = model_.radius[i_] + model_.radius[j];
    contact.stiffness = law->stiffness;
    contact.damping = law->damping;
    contact.damping_ratio = 0;
    contact.layer = 0;
    return true;
  }

  const Model& model_;
  Index i_;
  Index body_;
  Index material_;
};

/// Returns the friction constants of a contact of particles i and j with `stiffness` [N/m].
/// Contacts within a body have no friction.
inline Friction pair_friction(const Model& model, Index i, Index j, Real stiffness) {
  if (model.body[i] == model.body[j]) return {};
  const Real coefficient = model.contact_law(model.material[i], model.material[j]).friction;
  if (coefficient == 0) return {};
  const Real mass = model.mass[i] * model.mass[j] / (model.mass[i] + model.mass[j]);
  return {coefficient, sticking_drag(stiffness, mass)};
}

/// Returns the arms of particles i and j. `way` is the vector from j to i [m].
inline ContactArms pair_arms(const Model& model, Index i, Index j, const Vec3& way) {
  return contact_arms(way, i >= model.free_count, model.radius[i], j >= model.free_count,
                      model.radius[j]);
}

/// Returns the velocity, relative to particle i, of the body point at `arm` [m] from the particle.
/// `spins` are the angular velocities of the rigid bodies [rad/s]. The result is 0 for a free
/// particle.
inline Vec3 turning_velocity(const Model& model, const std::vector<Vec3>& spins, Index i,
                             const Vec3& arm) {
  if (i >= model.free_count) return spins[model.bodies[model.body[i]].rigid].cross(arm);
  return Vec3::Zero();
}

/// Returns the friction constants of particle i at a wall.
inline Friction wall_friction(const Model& model, Index i) {
  const ContactLaw& law = model.wall_laws[model.material[i]];
  if (law.friction == 0) return {};
  return {law.friction, sticking_drag(law.stiffness, model.mass[i])};
}

}  // namespace vat
