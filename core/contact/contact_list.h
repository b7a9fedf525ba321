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

/// The pairs of particles that are in contact or soon may be, kept as long as no particle has moved
/// so far that one may be missing. Which pairs it calls, and in which order, depends on positions
/// and indices alone, and not on when it was made.
class ContactList {
 public:
  /// From now on the list has every pair up to `slack` [m] beyond its threshold. Searches only
  /// where something has moved too far since the last time; needs the column liquid_cells then.
  void update(StepContext& context, Real slack);
  /// Whether update() would not have to search.
  bool is_current(const StepContext& context, Real slack);

  /// Of its entries, two a pair and some of pairs that are not so near.
  std::size_t size() const;

  /// The particles of a block that have entries, by index.
  std::span<const Index> particles(std::size_t block) const { return particles_[block]; }

  /// Calls f(contact) for every dynamic connection of particle i: with other bodies, by the other
  /// particle's index, then with its own body, the same; with `slack` those too that are up to so
  /// much beyond their threshold.
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

  /// The entries of particle i that are of its own body and in no list of others.
  std::span<const Index> within(const Model& model, Index i) const {
    if (own_list_[model.body[i]] == kNoList) return {};
    return within_[own_list_[model.body[i]]].of(i);
  }

  bool is_between_current(const StepContext& context, Real slack);
  void search_between(StepContext& context, Real skin);
  /// Particles that may touch one of another body, for a search up to `skin` beyond the thresholds.
  void find_candidates(const StepContext& context, Real skin);
  void find_between(const StepContext& context, Index i, Real skin,
                    std::vector<Index>& found) const;
  void make_own_lists(const Model& model);
  void list_particles(const StepContext& context);

  static constexpr Index kNoList = ~Index{0};

  PairTable between_;  ///< of different bodies; in a periodic world of all
  std::vector<Vec3> built_at_;
  Real skin_ = 0;  ///< of that table; 0: there is none [m]
  std::vector<SelfContactList> within_;
  std::vector<Index> own_list_;                ///< by body: place in within_
  std::vector<std::vector<Index>> particles_;  ///< by block, of both
  bool are_listed_ = false;
  // Scratch.
  BodyBoxes boxes_;
  std::vector<Index> candidates_;
  std::vector<char> is_candidate_;
  SortedParticles solids_;      ///< those of the candidates
  std::vector<Real> farthest_;  ///< by block
};

}  // namespace vat
