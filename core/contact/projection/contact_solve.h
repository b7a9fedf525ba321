#pragma once

#include <functional>
#include <span>
#include <vector>

#include "core/contact/projection/contact_constraint.h"
#include "core/contact/projection/contact_islands.h"
#include "core/contact/projection/contact_newton.h"
#include "core/contact/projection/sweep_row.h"

namespace vat {

/// Buffers of ContactSolve::sweep().
struct ContactNewtonScratch {
  struct Block {
    ContactNewton newton;
    std::vector<SweepRow> rows;
    std::vector<Real> excess;
  };
  std::vector<Block> blocks;        ///< by block of islands
  std::vector<Index> place_of_end;  ///< free particles, then rigid bodies
};

/// A solve for the impulses of contacts at a fixed geometry, and the velocities that the impulses
/// change.
struct ContactSolve {
  /// Sets the excess of a row: its kind and the terms of this kind.
  using SetExcess = std::function<void(const ContactConstraint&, SweepRow&)>;

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

  /// Relaxes the contacts of each island in order and in reverse order, until no contact of the
  /// island changes. Islands are independent and may run on different threads. Returns whether the
  /// sweeps have converged. If the sweeps of an island converge slowly, ContactNewton replaces the
  /// remaining ones.
  /// The nonlinear conjugate gradient method of M. Silcowitz-Hansen, S. Niebe, K. Erleben, The
  /// Visual Computer 26 (2010) 893, accelerates the convergence. In this method, the change of a
  /// sweep is a gradient. While the gradients decrease, the next sweep starts at an extrapolation
  /// of the last sweeps.
  bool sweep(std::vector<ContactConstraint>& constraints, const ContactIslands& islands,
             ContactNewtonScratch& scratch, const SetExcess& set_excess);

 private:
  struct IslandResult {
    std::size_t iterations = 0;  ///< sweeps and Newton steps
    bool is_solved = false;
  };
  IslandResult sweep_island(std::vector<ContactConstraint>& constraints,
                            std::span<const Index> island, std::size_t most,
                            ContactNewtonScratch& scratch, std::size_t block,
                            const SetExcess& set_excess);
  SweepRow make_row(const ContactConstraint& contact) const;
  /// Sets the impulse of `contact` to that of `row`, and adds its change to the momentum of the
  /// ends. The velocities already include this change.
  void store(const SweepRow& row, ContactConstraint& contact) const;
  Vec3 wall_velocity(const ContactConstraint& contact) const;
  Vec3 velocity(const ContactEnd& end) const;
  Real mobility(const ContactEnd& end, const Vec3& direction) const;
  void add_momentum(const ContactEnd& end, const Vec3& impulse) const;
  void apply(const ContactEnd& end, const Vec3& impulse);
  void set_arms(ContactConstraint& contact, Real distance) const;
};

}  // namespace vat
