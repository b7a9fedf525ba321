#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "core/contact/body_boxes.h"
#include "core/contact/contact_rules.h"
#include "core/contact/contact_search.h"
#include "core/contact/pair_table.h"
#include "core/contact/self_contact_list.h"
#include "core/state/state.h"

namespace vat {

struct StepContext;

/// A list of the pairs of particles that are or may soon be in contact. The list remains valid
/// until a pair may be missing because a particle has moved too far. The visited pairs and their
/// order depend only on positions and indices, and not on the time of the search.
class ContactList {
 public:
  /// Updates the list to contain all pairs up to `slack` [m] beyond their threshold. Searches only
  /// if the list is not current. A search requires the column liquid_cells (see Column).
  void update(StepContext& context, Real slack);
  /// Returns whether the list is valid for `slack` [m], so that update() would not search.
  bool is_current(const StepContext& context, Real slack);

  /// Returns the number of entries: two for each pair, including pairs beyond the slack.
  std::size_t size() const;

  /// Returns the particles of a block that have entries, in ascending order.
  std::span<const Index> particles(std::size_t block) const { return particles_[block]; }

  /// Calls f(contact) for each contact of particle i, including pairs up to `slack` [m] beyond
  /// their threshold. The contacts with other bodies precede those within the body. Both groups are
  /// ordered by the other particle.
  template <class F>
  void for_each(const Model& model, const Configuration& at, Index i, F&& f, Real slack = 0) const {
    model.periodic.any() ? visit<true>(model, at, i, slack, f)
                         : visit<false>(model, at, i, slack, f);
  }

 private:
  template <bool periodic, class F>
  void visit(const Model& model, const Configuration& at, Index i, Real slack, F&& f) const {
    const ContactRules rules(model, i);
    const Real reach = model.contact_reach + slack;
    const Real reach2 = reach * reach;
    const Vec3 p = periodic ? model.periodic.wrap(at.position[i]) : at.position[i];
    const Vec3* const positions = at.position.data();
    const auto look_at = [&](std::span<const Index> others) {
      for (const Index j : others) {
        const Vec3 x = periodic
                           ? model.periodic.nearest(Vec3(p - model.periodic.wrap(positions[j])))
                           : Vec3(p - positions[j]);
        const Real r2 = x.squaredNorm();
        if (!(r2 < reach2)) continue;
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
    };
    look_at(between_.of(i));
    if (!within_.empty()) look_at(within(model, i));
  }

  /// Returns the entries of particle i in within_, the lists of pairs within a body.
  std::span<const Index> within(const Model& model, Index i) const {
    if (own_list_[model.body[i]] == kNoList) return {};
    return within_[own_list_[model.body[i]]].of(i);
  }

  bool is_between_current(const StepContext& context, Real slack);
  void search_between(StepContext& context, Real skin);
  /// Finds the particles that may contact another body, for a search up to `skin` [m] beyond the
  /// thresholds.
  void find_candidates(const StepContext& context, Real skin);
  void find_between(const StepContext& context, Index i, Real skin,
                    std::vector<Index>& found) const;
  void make_own_lists(const Model& model);
  void list_particles(const StepContext& context);

  static constexpr Index kNoList = ~Index{0};

  PairTable between_;  ///< pairs of different bodies; in a periodic world, all pairs
  std::vector<Vec3> built_at_;
  Real skin_ = 0;  ///< range of between_ beyond the thresholds; 0: no table [m]
  std::vector<SelfContactList> within_;
  std::vector<Index> own_list_;                ///< by body: index in within_
  std::vector<std::vector<Index>> particles_;  ///< particles with entries, by block
  bool are_listed_ = false;
  // Buffers:
  BodyBoxes boxes_;
  std::vector<Index> candidates_;
  std::vector<char> is_candidate_;
  SortedParticles solids_;      ///< the solid candidates
  std::vector<Real> farthest_;  ///< by block
};

}  // namespace vat
