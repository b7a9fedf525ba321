#pragma once

#include <span>
#include <vector>

#include "core/contact/contact_rules.h"
#include "core/neighbours/uniform_grid.h"
#include "core/state/state.h"

namespace vat {

/// Particles in the order of the cells of a grid, with a separate array for each coordinate.
struct SortedParticles {
  UniformGrid grid;
  std::vector<Index> particle;  ///< by slot
  std::vector<Index> body;
  std::vector<Real> x;
  std::vector<Real> y;
  std::vector<Real> z;

  /// Sorts `particles` into cells of at least `cell_size` [m], which should be the search radius.
  /// In a periodic world, the particles are replaced by their images in the box.
  void build(const Model& model, const std::vector<Vec3>& positions,
             std::span<const Index> particles, Real cell_size);

 private:
  std::vector<Vec3> places_;  ///< positions in input order
};

/// A search for the particles in contact with particle i, including pairs up to `slack` [m] beyond
/// their threshold.
class ContactSearch {
 public:
  ContactSearch(const Model& model, const Configuration& at, Index i, Real slack)
      : model_(model),
        rules_(model, i),
        place_(model.periodic.wrap(at.position[i])),
        slack_(slack),
        reach_(model.contact_reach + slack) {}

  /// Calls f(j) with j = index_of(slot) for each near point for which wanted(slot) is true. In a
  /// periodic world, a point may be visited more than once.
  template <class Points, class Wanted, class IndexOf, class F>
  void look_in(const Points& points, Wanted&& wanted, IndexOf&& index_of, F&& f) const {
    const Real reach2 = reach_ * reach_;
    const auto look_from = [&](const Vec3& p) {
      points.grid.for_each_run(p, reach_, [&](Index begin, Index end) {
        for (Index slot = begin; slot < end; ++slot) {
          if (!wanted(slot)) continue;
          const Vec3 x(p.x() - points.x[slot], p.y() - points.y[slot], p.z() - points.z[slot]);
          const Real r2 = x.squaredNorm();
          if (r2 < reach2 && is_near(index_of(slot), r2)) f(index_of(slot));
        }
      });
    };
    if (model_.periodic.any()) {
      model_.periodic.for_each_image(place_, reach_,
                                     [&](const Vec3& shift) { look_from(place_ + shift); });
    } else {
      look_from(place_);
    }
  }

 private:
  bool is_near(Index j, Real r2) const {
    Contact contact;
    if (!rules_.find_law(j, contact)) return false;
    const Real notice = contact.threshold + slack_;
    return r2 < notice * notice && !rules_.excluded(j);
  }

  const Model& model_;
  ContactRules rules_;
  Vec3 place_;
  Real slack_;
  Real reach_;
};

}  // namespace vat
