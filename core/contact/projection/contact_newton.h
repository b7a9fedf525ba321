#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/contact/projection/contact_constraint.h"
#include "core/numerics/band_factor.h"

namespace vat {

struct ContactSolve;

/// Solves for the impulses of an island of contacts at a fixed geometry by the method of
/// multipliers (R. T. Rockafellar, Math. Oper. Res. 1 (1976) 97). Its number of iterations does not
/// grow with the number of bodies in a row. Each iteration minimises a convex function of the
/// velocities by Newton's method with a band Cholesky factor. The limits of friction are those of
/// the last normal impulses.
class ContactNewton {
 public:
  static constexpr std::size_t kNever = ~std::size_t{0};

  /// Orders the bodies of `island` along its longest axis. Returns the cost of run() in rounds of
  /// sweeps, or kNever if the bodies are too wide for a band. `place_of_end` has one entry per free
  /// particle and rigid body; only those of the island are changed.
  std::size_t prepare(const ContactSolve& solve, std::span<const ContactConstraint> constraints,
                      std::span<const Index> island, std::span<Index> place_of_end);
  /// Changes the impulses of the contacts of the island of prepare(), and the velocities of their
  /// ends. `excess` has one value per contact of the island: its separation speed above the
  /// required one [m/s].
  void run(ContactSolve& solve, std::span<ContactConstraint> constraints,
           std::span<const Index> island, std::span<const Real> excess,
           std::span<const Index> place_of_end);

 private:
  static constexpr Index kNoBlock = ~Index{0};

  struct Mover {
    Index end;
    Real along;  ///< position along the longest axis [m]
  };
  struct Side {
    Index block = kNoBlock;  ///< of the velocity; the next block is that of the spin
    bool turns = false;
    Vec3 arm = Vec3::Zero();
  };
  struct Row {
    std::array<Side, 2> sides;
    Vec3 normal;
    Vec3 slip;    ///< above the required one, before the changes of velocities [m/s]
    Real mass;    ///< inverse of the mobility [kg]
    Real weight;  ///< of the multiplier [kg]
    Real limit;   ///< of friction [N s]
    Real friction;
    Real scale;       ///< displacement in thresholds per unit of speed [s/m]
    Vec3 multiplier;  ///< [N s]
    Vec3 at;          ///< slip at the present changes [m/s]
    Vec3 turn;        ///< its change by a Newton step
  };
  /// The impulse of a contact at a slip.
  struct Reply {
    Vec3 impulse;
    Mat3 slope;  ///< -d impulse / d slip [kg]
  };

  void place_movers(const ContactSolve& solve, std::span<const ContactConstraint> constraints,
                    std::span<const Index> island, std::span<Index> place_of_end);
  void add_rows(const ContactSolve& solve, std::span<const ContactConstraint> constraints,
                std::span<const Index> island, std::span<const Real> excess,
                std::span<const Index> place_of_end);
  static Vec3 slip_by(const Row& row, std::span<const Vec3> change);
  static Reply reply(const Row& row, const Vec3& slip);
  Real find_length() const;
  void add_slope(const Row& row, const Mat3& slope);
  bool step();
  bool minimise();

  std::vector<Mover> movers_;
  std::vector<Row> rows_;
  std::vector<Mat3> mass_;    ///< by block
  std::vector<Vec3> change_;  ///< of velocities and spins, by block
  std::vector<Vec3> newton_;  ///< change of change_
  BandFactor factor_;
  Index width_ = 0;
};

}  // namespace vat
