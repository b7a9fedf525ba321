#pragma once

#include <algorithm>
#include <atomic>
#include <span>
#include <vector>

#include "core/contact/projection/contact_constraint.h"
#include "core/contact/projection/contact_islands.h"
#include "core/contact/projection/contact_newton.h"
#include "core/contact/projection/sweep_progress.h"
#include "core/support/parallel.h"

namespace vat {

/// Buffers of ContactSolve::sweep().
struct ContactNewtonScratch {
  struct Block {
    ContactNewton newton;
    std::vector<Real> excess;
  };
  std::vector<Block> blocks;        ///< by block of islands
  std::vector<Index> place_of_end;  ///< free particles, then rigid bodies
};

/// A solve for the impulses of contacts at a fixed geometry, and the velocities that the impulses
/// change.
struct ContactSolve {
  const ForceModel& force_model;
  const VatMotion& vat;             ///< motion of the walls, for their friction
  Configuration& at;                ///< positions, and velocities that the impulses change
  std::vector<RigidMotion>& rigid;  ///< motion of the rigid bodies of `at`
  Real dt;                          ///< [s]

  const Model& model() const { return force_model.model; }

  /// Sets `rigid`, and the normals, arms and mobilities of the contacts. `predicted` is the
  /// configuration at the end of the step, in which the direction of a contact may differ.
  void set_geometry(const Configuration& predicted, std::vector<ContactConstraint>& constraints);

  /// Returns the relative velocity of the two ends at the contact point [m/s].
  Vec3 slip(const ContactConstraint& contact) const;
  /// Adds the initial impulse `impulse` [N s], limited to repulsion and to the friction limit of
  /// the contact.
  void start_from(ContactConstraint& contact, const Vec3& impulse);
  /// Adds `change` [N s] to the normal impulse. Returns the resulting relative displacement of the
  /// ends in `dt`, in thresholds.
  Real push(ContactConstraint& contact, Real change);
  /// Changes the friction impulse so that the contact sticks, or to the friction limit. Returns the
  /// resulting relative displacement of the ends in `dt`, in thresholds.
  Real apply_friction(ContactConstraint& contact);

  /// Relaxes the contacts of each island in order and in reverse order, until no contact of the
  /// island changes. excess(contact) returns the separation speed above the required one [m/s].
  /// Islands are independent and may run on different threads. Returns whether the sweeps have
  /// converged. If the sweeps of an island converge slowly, ContactNewton replaces the remaining
  /// ones.
  /// The nonlinear conjugate gradient method of M. Silcowitz-Hansen, S. Niebe, K. Erleben, The
  /// Visual Computer 26 (2010) 893, accelerates the convergence. In this method, the change of a
  /// sweep is a gradient. While the gradients decrease, the next sweep starts at an extrapolation
  /// of the last sweeps.
  template <class Excess>
  bool sweep(std::vector<ContactConstraint>& constraints, const ContactIslands& islands,
             ContactNewtonScratch& scratch, Excess&& excess) {
    constexpr std::size_t kIslandsPerBlock = 8;
    // The maximum number of operations is about equal for few and many contacts.
    const std::size_t most =
        std::clamp<std::size_t>(10'000 / std::max<std::size_t>(constraints.size(), 1), 50, 1000);
    std::atomic<std::size_t> greatest = 0;
    std::atomic<bool> all_solved = true;
    scratch.place_of_end.resize(model().free_count + rigid.size());
    scratch.blocks.resize((islands.count() + kIslandsPerBlock - 1) / kIslandsPerBlock);
    for_blocks<kIslandsPerBlock>(
        force_model.runner, islands.count(), [&](std::size_t begin, std::size_t end) {
          for (std::size_t island = begin; island < end; ++island) {
            const IslandResult result = sweep_island(constraints, islands[island], most, scratch,
                                                     begin / kIslandsPerBlock, excess);
            raise(greatest, result.iterations);
            if (!result.is_solved) all_solved = false;
          }
        });
    if (force_model.report != nullptr) force_model.report->iterations.contacts += greatest;
    return all_solved;
  }

 private:
  struct IslandResult {
    std::size_t iterations = 0;  ///< sweeps and Newton steps
    bool is_solved = false;
  };
  static void raise(std::atomic<std::size_t>& greatest, std::size_t value) {
    std::size_t known = greatest;
    while (known < value && !greatest.compare_exchange_weak(known, value)) {
    }
  }
  template <class Excess>
  IslandResult sweep_island(std::vector<ContactConstraint>& constraints,
                            std::span<const Index> island, std::size_t most,
                            ContactNewtonScratch& scratch, std::size_t block, Excess&& excess) {
    constexpr Real kTolerance = 1e-8;
    constexpr int kMaxRuns = 2;
    // A prediction from fewer rounds than this part of the cost is not reliable enough.
    constexpr std::size_t kPatience = 6;
    ContactNewtonScratch::Block& own = scratch.blocks[block];
    SweepProgress progress(kTolerance);
    IslandResult result;
    int runs = 0;
    Real last = 0;
    const auto relax = [&](ContactConstraint& contact) {
      const Real wanted = contact.push - excess(contact) / contact.mobility;
      const Real change = push(contact, std::max(Real{0}, wanted) - contact.push);
      return std::max(change, apply_friction(contact));
    };
    for (std::size_t round = 1, last_round = most; round <= last_round; ++round) {
      Real change = 0;
      for (const Index c : island) constraints[c].gradient = -constraints[c].impulse();
      for (const Index c : island) change = std::max(change, relax(constraints[c]));
      for (auto it = island.rbegin(); it != island.rend(); ++it) {
        const Index c = *it;
        change = std::max(change, relax(constraints[c]));
      }
      result.iterations += 2;
      result.is_solved = change <= kTolerance;
      if (result.is_solved) break;
      progress.add(change);
      if (progress.has_prediction() && runs < kMaxRuns) {
        const std::size_t cost =
            own.newton.prepare(*this, constraints, island, scratch.place_of_end);
        if (progress.rounds() >= cost || (kPatience * progress.rounds() >= cost &&
                                          progress.rounds_left() > static_cast<Real>(cost))) {
          own.excess.clear();
          for (const Index c : island) own.excess.push_back(excess(constraints[c]));
          result.iterations +=
              own.newton.run(*this, constraints, island, own.excess, scratch.place_of_end);
          ++runs;
          last_round = std::max(most, 2 * round);
          last = 0;
          progress.restart();
          continue;
        }
      }
      last = extrapolate(constraints, island, last);
    }
    return result;
  }
  Vec3 velocity(const ContactEnd& end) const;
  Real mobility(const ContactEnd& end, const Vec3& direction) const;
  /// Extrapolates the impulses of the last sweeps of an island. Returns the squared norm of the
  /// gradients [N^2 s^2]. `last` is the result after the preceding sweep, or 0 after the first
  /// sweep.
  Real extrapolate(std::vector<ContactConstraint>& constraints, std::span<const Index> island,
                   Real last);
  void apply(const ContactEnd& end, const Vec3& impulse);
  void set_arms(ContactConstraint& contact, Real distance) const;
};

}  // namespace vat
