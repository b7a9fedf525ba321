#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <vector>

#include "core/forces/contact_rules.h"
#include "core/state/state.h"
#include "core/support/parallel.h"

namespace vat {

struct StepContext;

/// The pairs of particles that are in contact or soon may be, kept as long as no particle has moved
/// so far that one may be missing. Which pairs it calls, and in which order, depends on positions
/// and indices alone, and not on when it was made.
class ContactList {
 public:
  /// From now on the list has every pair up to `slack` [m] beyond its threshold. Searches, and
  /// sorts the solids, only where something has moved too far since the last time; needs the column
  /// liquid_cells then.
  void update(StepContext& context, Real slack);
  /// Whether update() would not have to search.
  bool is_current(const StepContext& context, Real slack);

  /// Of its entries, two a pair and some of pairs that are not so near.
  std::size_t size() const;

  /// Calls f(contact) for every dynamic connection of particle i, by the other one's index; with
  /// `slack` those too that are up to so much beyond their threshold.
  template <class F>
  void for_each(const Model& model, const Configuration& at, Index i, F&& f, Real slack = 0) const {
    model.periodic.any() ? visit<true>(model, at, i, slack, f)
                         : visit<false>(model, at, i, slack, f);
  }

 private:
  /// Of one block of particles: those of its k-th are [begin[k], begin[k + 1]).
  struct Block {
    std::vector<Index> others;
    std::array<std::size_t, kBlockSize + 1> begin;
  };

  template <bool periodic, class F>
  void visit(const Model& model, const Configuration& at, Index i, Real slack, F&& f) const {
    const Block& block = blocks_[i / kBlockSize];
    const ContactRules rules(model, i);
    const Real reach = model.contact_reach + slack;
    const Vec3 p = periodic ? model.periodic.wrap(at.position[i]) : at.position[i];
    for (std::size_t k = block.begin[i % kBlockSize]; k < block.begin[i % kBlockSize + 1]; ++k) {
      const Index j = block.others[k];
      const Vec3 x = periodic
                         ? model.periodic.nearest(Vec3(p - model.periodic.wrap(at.position[j])))
                         : Vec3(p - at.position[j]);
      const Real r2 = x.squaredNorm();
      if (!(r2 < reach * reach)) continue;
      Contact contact;
      if (!rules.find_law(j, contact)) continue;
      const Real notice = contact.threshold + slack;
      if (!(r2 < notice * notice)) continue;
      contact.self = i;
      contact.other = j;
      contact.x = x;
      contact.distance = std::sqrt(r2);
      f(contact);
    }
  }

  using Box = Eigen::AlignedBox<Real, 3>;

  void search(StepContext& context, Real skin);
  /// Which bodies' boxes, grown by the reach, overlap; in a world that does not repeat itself.
  void find_near_bodies(const StepContext& context, Real skin);
  bool may_touch(const StepContext& context, Index i) const;

  std::vector<Block> blocks_;
  std::vector<Box> boxes_;                ///< by body: of what may touch it
  std::vector<std::vector<Index>> near_;  ///< by body: others
  std::vector<Index> by_left_;            ///< bodies, by the least x of their boxes
  std::vector<Vec3> built_at_;
  std::vector<Real> farthest_;  ///< by block
  Real skin_ = 0;               ///< of the list; 0: there is none [m]
};

}  // namespace vat
