#pragma once

#include <algorithm>
#include <vector>

#include "core/contact/projection/contact_constraint.h"

namespace vat {

/// The impulses of contacts at one geometry, and the velocities that they change.
struct ContactSolve {
  const ForceModel& force_model;
  const VatMotion& vat;             ///< its velocity is that which walls rub with
  Configuration& at;                ///< its geometry counts, and its velocities change
  std::vector<RigidMotion>& rigid;  ///< of `at`
  Real dt;                          ///< [s]

  const Model& model() const { return force_model.model; }

  /// Fills `rigid`, and normals, arms and mobilities of the contacts; `predicted` are the positions
  /// to which the contacts lead, in which they may have turned away from one another.
  void set_geometry(const Configuration& predicted, std::vector<ContactConstraint>& constraints);

  /// Relative velocity of the two ends at the point of contact [m/s].
  Vec3 slip(const ContactConstraint& contact) const;
  /// Adds an impulse to start from [N s], as far as the contact can have it.
  void start_from(ContactConstraint& contact, const Vec3& impulse);
  /// Adds `change` [N s] to the push; returns how far that moves the ends in `dt`, in thresholds.
  Real push(ContactConstraint& contact, Real change);
  /// Rubs until nothing slips or the friction of the push is reached; returns the same.
  Real apply_friction(ContactConstraint& contact);

  /// Calls relax(contact), which returns its change in thresholds, for one contact after the other,
  /// there and back, until none changes; true where that came about. Made to converge fast by the
  /// conjugate gradients of M. Silcowitz-Hansen, S. Niebe, K. Erleben, The Visual Computer 26
  /// (2010) 893: the change of a sweep is a gradient, and while gradients get smaller the next
  /// sweep starts from further on in the direction of the last ones.
  template <class Relax>
  bool sweep(std::vector<ContactConstraint>& constraints, Relax&& relax) {
    constexpr Real kTolerance = 1e-8;
    // Few contacts may take what many cost.
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
  /// Returns the gradients' size [N^2 s^2]; `last` is that of the sweep before, 0 at the first.
  Real extrapolate(std::vector<ContactConstraint>& constraints, Real last);
  void apply(const ContactEnd& end, const Vec3& impulse);
  void set_arms(ContactConstraint& contact, Real distance) const;
};

}  // namespace vat
