#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "core/laws/friction.h"
#include "core/model/model.h"

namespace vat {

/// One dynamic connection (Boldt def. 0.2) seen from particle `self`; distance < threshold.
struct Contact {
  Index self = 0;
  Index other = 0;
  Vec3 x;              ///< position of self minus position of other [m]
  Real distance;       ///< |x| [m]
  Real threshold;      ///< and rest length l of a spring [m]
  Real stiffness;      ///< [N/m]
  Real damping;        ///< [N s/m]
  Real damping_ratio;  ///< of what has a restitution, in place of damping
  Real layer;          ///< of a layer: the width of its part that pulls [m]; 0: a spring
};

/// Which law joins particles i and j, if any, as a Contact without its geometry: not two particles
/// of one rigid body, nor of liquids of one material (they meet by SPH), nor excluded pairs of a
/// deformable body, wherever their images are.
class ContactRules {
 public:
  ContactRules(const Model& model, Index i)
      : model_(model), i_(i), body_(model.body[i]), material_(model.material[i]) {}

  /// False: no law. Otherwise fills threshold and constants.
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

  /// Asked only of pairs within reach: exclusions cost a search.
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

/// Friction of a contact of particles i and j with this stiffness [N/m]: none within a body.
inline Friction pair_friction(const Model& model, Index i, Index j, Real stiffness) {
  if (model.body[i] == model.body[j]) return {};
  const Real coefficient = model.contact_law(model.material[i], model.material[j]).friction;
  if (coefficient == 0) return {};
  const Real mass = model.mass[i] * model.mass[j] / (model.mass[i] + model.mass[j]);
  return {coefficient, sticking_drag(stiffness, mass)};
}

/// Where particles i and j rub, `way` [m] from j to i.
inline ContactArms pair_arms(const Model& model, Index i, Index j, const Vec3& way) {
  return contact_arms(way, i >= model.free_count, model.radius[i], j >= model.free_count,
                      model.radius[j]);
}

/// The velocity that its body's spin gives a point at `arm` from particle i, beside the particle's;
/// `spins` are by rigid body.
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
