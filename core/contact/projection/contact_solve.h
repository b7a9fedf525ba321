#pragma once

#include <algorithm>
#include <vector>

#include "core/contact/projection/contact_constraint.h"

namespace vat {

/// The impulses of contacts for one geometry, and the velocities that they change.
struct ContactSolve {
  const ForceModel& force_model;
  const VatMotion& vat;             ///< its velocity determines the friction of walls
  Configuration& at;                ///< provides the geometry; its velocities change
  std::vector<RigidMotion>& rigid;  ///< the rigid bodies of `at`
  Real dt;                          ///< [s]

  const Model& model() const { return force_model.model; }

  /// Sets `rigid`, and normals, arms and mobilities of the contacts. `predicted` are the positions
  /// at the end of the step, in which the direction of a contact may differ.
  void set_geometry(const Configuration& predicted, std::vector<ContactConstraint>& constraints);

  /// Relative velocity of the two ends at the point of contact [m/s].
  Vec3 slip(const ContactConstraint& contact) const;
  /// Adds an initial impulse [N s], limited to the constraints of the contact.
  void start_from(ContactConstraint& contact, const Vec3& impulse);
  /// Adds `change` [N s] to the normal impulse. Returns the resulting displacement of the ends in
  /// `dt`, in thresholds.
  Real push(ContactConstraint& contact, Real change);
  /// Changes the friction impulse until the contact sticks or reaches the friction limit. Returns
  /// the displacement, in thresholds.
  Real apply_friction(ContactConstraint& contact);

  /// Calls relax(contact), which returns its change in thresholds, for all contacts in order and in
  /// reverse order, until none changes. Returns whether this was reached. Convergence is
  /// accelerated by the conjugate gradients of M. Silcowitz-Hansen, S. Niebe, K. Erleben, The
  /// Visual Computer 26 (2010) 893: the change of a sweep is a gradient, and while gradients
  /// decrease, the next sweep starts at an extrapolation of the last ones.
  template <class Relax>
  bool sweep(std::vector<ContactConstraint>& constraints, Relax&& relax) {
    constexpr Real kTolerance = 1e-8;
    // Few contacts may take as many operations as many contacts.
    const std::size_t most =
        std::clamp<std::size_t>(10'000 / std::max<std::size_t>(constraints.size(), 1), 50, 1000);
    Real last = 0;
    for (std::size_t round = 0; round < most; ++round) {
      Real change = 0;
      for (ContactConstraint& contact : constraints) contact.gradient = -contact.impulse();
      for (ContactConstraint& contact : constraints) change = std::max(change, relax(contact));
      for (auto contact = constraints.rbegin(); contact != constraints.rend(); ++contact) {
        change = std::max(change, relax(*contact));
      }
      if (change <= kTolerance) return true;
      last = extrapolate(constraints, last);
    }
    return false;
  }

 private:
  Vec3 velocity(const ContactEnd& end) const;
  Real mobility(const ContactEnd& end, const Vec3& direction) const;
  /// Returns the squared size of the gradients [N^2 s^2]. `last` is that of the preceding sweep, 0
  /// at the first.
  Real extrapolate(std::vector<ContactConstraint>& constraints, Real last);
  void apply(const ContactEnd& end, const Vec3& impulse);
  void set_arms(ContactConstraint& contact, Real distance) const;
};

}  // namespace vat
