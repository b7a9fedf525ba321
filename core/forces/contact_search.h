#pragma once

#include <cmath>

#include "core/forces/contact_rules.h"
#include "core/step/workspace.h"

namespace vat {

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

  if (model.is_coupled && i < model.liquid_count) return;
  search(work.solids, model.liquid_count, [](Index) { return true; });
  if (model.is_coupled) return;
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
