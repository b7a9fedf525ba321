#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "core/laws/friction.h"
#include "core/model/model.h"

namespace vat {

/// A dynamic connection (Boldt def. 0.2), seen from particle `self`, with distance < threshold.
struct Contact {
  Index self = 0;
  Index other = 0;
  Vec3 x;              ///< position of self minus position of other [m]
  Real distance;       ///< |x| [m]
  Real threshold;      ///< also the rest length l of a spring [m]
  Real stiffness;      ///< [N/m]
  Real damping;        ///< [N s/m]
  Real damping_ratio;  ///< for a restitution, in place of damping
  Real layer;          ///< width of the attracting part of a layer [m]; 0: a spring
};

/// Finds the law of the contact of particles i and j, as a Contact without geometry. There is no
/// contact between particles of one rigid body or of liquids of one material (which interact by
/// SPH), and between excluded pairs of a deformable body, including their images.
class ContactRules {
 public:
  ContactRules(const Model& model, Index i)
      : model_(model), i_(i), body_(model.body[i]), material_(model.material[i]) {}

  /// Returns whether there is a law, and sets threshold and constants.
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

  /// Returns whether the pair is excluded. Call it for pairs in reach only, because it searches.
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

/// Friction of a contact of particles i and j with this stiffness [N/m]. Zero within a
/// body.
inline Friction pair_friction(const Model& model, Index i, Index j, Real stiffness) {
  if (model.body[i] == model.body[j]) return {};
  const Real coefficient = model.contact_law(model.material[i], model.material[j]).friction;
  if (coefficient == 0) return {};
  const Real mass = model.mass[i] * model.mass[j] / (model.mass[i] + model.mass[j]);
  return {coefficient, sticking_drag(stiffness, mass)};
}

/// The arms of particles i and j; `way` [m] points from j to i.
inline ContactArms pair_arms(const Model& model, Index i, Index j, const Vec3& way) {
  return contact_arms(way, i >= model.free_count, model.radius[i], j >= model.free_count,
                      model.radius[j]);
}

/// The velocity of the point at `arm` from particle i, relative to the particle, by the rotation of
/// its body. `spins` are by rigid body.
inline Vec3 turning_velocity(const Model& model, const std::vector<Vec3>& spins, Index i,
                             const Vec3& arm) {
  if (i >= model.free_count) return spins[model.bodies[model.body[i]].rigid].cross(arm);
  return Vec3::Zero();
}

/// Friction of particle i at a wall.
inline Friction wall_friction(const Model& model, Index i) {
  const ContactLaw& law = model.wall_laws[model.material[i]];
  if (law.friction == 0) return {};
  return {law.friction, sticking_drag(law.stiffness, model.mass[i])};
}

}  // namespace vat
