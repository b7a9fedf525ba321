#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/contact/projection/contact_constraint.h"
#include "core/contact/projection/contact_row.h"
#include "core/numerics/band_factor.h"

namespace vat {

struct ContactSolve;

/// Solves for the impulses of an island of contacts at a fixed geometry by the method of
/// multipliers (R. T. Rockafellar, Math. Oper. Res. 1 (1976) 97). Its number of iterations does not
/// grow with the number of bodies in a row. Each iteration minimises a convex function of the
/// velocities by Newton's method with a band Cholesky factor.
///
/// The laws of ContactRow change with each iteration. Lifts converge fast if the contacts stick.
/// If a contact slides fast, limits converge faster.
class ContactNewton {
 public:
  static constexpr std::size_t kNever = ~std::size_t{0};

  /// Orders the bodies of `island` along its longest axis. Returns the expected cost of run()
  /// in rounds of sweeps, or kNever if the bodies are too wide for a band.
  /// `place_of_end` has one entry per free particle and rigid body; only those of the island are
  /// changed.
  std::size_t prepare(const ContactSolve& solve, std::span<const ContactConstraint> constraints,
                      std::span<const Index> island, std::span<Index> place_of_end);
  /// Changes the impulses of the contacts of the island of prepare(), and the velocities of their
  /// ends. `excess` has one value per contact of the island: its separation speed above the
  /// required one [m/s]. Returns the number of Newton steps.
  std::size_t run(ContactSolve& solve, std::span<ContactConstraint> constraints,
                  std::span<const Index> island, std::span<const Real> excess,
                  std::span<const Index> place_of_end);

 private:
  struct Mover {
    Index end;
    Real along;  ///< position along the longest axis [m]
  };
  void add_block(Mat3 inverse_mass);
  void place_movers(const ContactSolve& solve, std::span<const ContactConstraint> constraints,
                    std::span<const Index> island, std::span<Index> place_of_end);
  /// Sets width_. Returns the displacement by the fastest slip of a contact in a step, in
  /// thresholds and times its friction.
  Real find_width(const ContactSolve& solve, std::span<const ContactConstraint> constraints,
                  std::span<const Index> island, std::span<const Index> place_of_end);
  void add_rows(const ContactSolve& solve, std::span<const ContactConstraint> constraints,
                std::span<const Index> island, std::span<const Real> excess,
                std::span<const Index> place_of_end);
  static Vec3 slip_by(const ContactRow& row, std::span<const Vec3> change);
  Real find_residual();
  Real find_length() const;
  void add_slopes(std::span<const ContactRow> rows);
  bool step();
  Real violation() const;
  bool minimise();
  Real update_multipliers();

  std::vector<Mover> movers_;
  std::vector<ContactRow> rows_;
  // By block: the velocity or the spin of a mover.
  std::vector<Mat3> mass_;
  std::vector<Mat3> inverse_mass_;
  std::vector<Vec3> change_;  ///< of velocities and spins
  std::vector<Vec3> newton_;  ///< the residual, then the change of change_ by a Newton step
  std::vector<Vec3> speed_;   ///< that the residual would cause
  BandFactor factor_;
  Index width_ = 0;
  bool has_limits_ = false;  ///< whether the rows of run() have limits instead of lifts
  Index steps_ = 0;          ///< Newton steps of run()
};

}  // namespace vat
