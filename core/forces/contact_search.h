#pragma once

#include <algorithm>
#include <cmath>

#include "core/model/model.h"
#include "core/step/workspace.h"

namespace vat {

/// One dynamic connection (Boldt def. 0.2) seen from particle `self`; distance < threshold.
struct Contact {
  Index self = 0;
  Index other = 0;
  Vec3 x;          ///< position of self minus position of other [m]
  Real distance;   ///< |x| [m]
  Real threshold;  ///< and rest length l [m]
  Real stiffness;  ///< [N/m]
  Real damping;    ///< [N s/m]
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
    contact.threshold = law.threshold > 0 ? law.threshold : model_.radius[i_] + model_.radius[j];
    contact.stiffness = law.stiffness;
    contact.damping = law.damping;
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
    return true;
  }

  const Model& model_;
  Index i_;
  Index body_;
  Index material_;
};

/// for_each_contact() of a world that is periodic, or is not: the latter has no images to look at.
template <bool periodic, class F>
void search_contacts(const Model& model, const Workspace& work, const Configuration& at, Index i,
                     Real slack, F&& f) {
  const ContactRules rules(model, i);
  const Vec3 p = periodic ? model.periodic.wrap(at.position[i]) : at.position[i];
  const Real reach = model.contact_reach + slack;
  const Real reach2 = reach * reach;
  const auto visit = [&](const CellSortedPoints& points, Index slot, Index j,
                         [[maybe_unused]] const Vec3& shift, auto&& wanted) {
    Vec3 x(p.x() - points.x[slot], p.y() - points.y[slot], p.z() - points.z[slot]);
    if constexpr (periodic) x += shift;
    const Real r2 = x.squaredNorm();
    if (!(r2 < reach2)) return;
    Contact contact;
    if (!wanted(j) || !rules.find_law(j, contact)) return;
    const Real notice = contact.threshold + slack;
    if (!(r2 < notice * notice) || rules.excluded(j)) return;
    contact.self = i;
    contact.other = j;
    contact.x = x;
    contact.distance = std::sqrt(r2);
    f(contact);
  };
  const auto search = [&](const CellSortedPoints& points, Index first, auto&& wanted) {
    const std::span<const Index> order = points.grid.order();
    const auto search_image = [&](const Vec3& shift) {
      const Vec3 image = periodic ? Vec3(p + shift) : p;
      points.grid.for_each_run(image, reach, [&](Index begin, Index end) {
        for (Index slot = begin; slot < end; ++slot) {
          visit(points, slot, first + order[slot], shift, wanted);
        }
      });
    };
    if constexpr (periodic) {
      model.periodic.for_each_image(p, reach, search_image);
    } else {
      search_image(Vec3::Zero());
    }
  };

  search(work.solids, model.liquid_count, [](Index) { return true; });
  if (i >= model.liquid_count) {
    search(work.liquid, 0, [](Index) { return true; });
  } else if (model.liquids_touch) {
    search(work.liquid, 0, [&](Index j) { return model.material[j] != model.material[i]; });
  }
}

/// Calls f(contact) for every dynamic connection of particle i, in an order that depends on
/// positions and indices alone; with `slack` [m] those too that are up to so much beyond their
/// threshold. In a periodic world, with the nearest images of the others. Needs the columns
/// liquid_cells and solid_cells.
template <class F>
void for_each_contact(const Model& model, const Workspace& work, const Configuration& at, Index i,
                      F&& f, Real slack = 0) {
  if (model.periodic.any()) {
    search_contacts<true>(model, work, at, i, slack, f);
  } else {
    search_contacts<false>(model, work, at, i, slack, f);
  }
}

}  // namespace vat
