#include "core/contact/projection/contact_newton.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/contact/projection/contact_solve.h"
#include "core/support/check.h"

namespace vat {
namespace {

constexpr int kMaxRounds = 8;
constexpr int kMaxSteps = 50;
constexpr Real kFirstWeight = 10;  // of a multiplier, relative to the mass of its contact
constexpr Real kLastWeight = 1e5;
constexpr Real kEnough = 1e-9;  // displacement in a step, in thresholds

Mat3 cross_matrix(const Vec3& a) {
  Mat3 m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

/// The inverse of an inverse inertia. Axes about which the body cannot turn get a unit inertia.
Mat3 inertia_of(Mat3 inverse) {
  for (int k = 0; k < 3; ++k) {
    if (inverse(k, k) == 0) inverse(k, k) = 1;
  }
  return inverse.inverse();
}

Index number_of(const ContactSolve& solve, const ContactEnd& end) {
  return end.rigid == kNoParticle ? end.particle : solve.model().free_count + end.rigid;
}

const Vec3& center_of(const ContactSolve& solve, Index end) {
  const Index free_count = solve.model().free_count;
  return end < free_count ? solve.at.position[end]
                          : solve.at.rigid[end - free_count].center_of_mass;
}

}  // namespace

void ContactNewton::place_movers(const ContactSolve& solve,
                                 std::span<const ContactConstraint> constraints,
                                 std::span<const Index> island, std::span<Index> place_of_end) {
  movers_.clear();
  mass_.clear();
  for (const Index c : island) {
    for (const ContactEnd& end : constraints[c].ends) {
      if (end.inverse_mass > 0) place_of_end[number_of(solve, end)] = kNoBlock;
    }
  }
  Vec3 low = Vec3::Constant(std::numeric_limits<Real>::infinity());
  Vec3 high = -low;
  for (const Index c : island) {
    for (const ContactEnd& end : constraints[c].ends) {
      const Index number = number_of(solve, end);
      if (end.inverse_mass == 0 || place_of_end[number] != kNoBlock) continue;
      place_of_end[number] = 0;
      movers_.push_back({number, 0});
      low = low.cwiseMin(center_of(solve, number));
      high = high.cwiseMax(center_of(solve, number));
    }
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  for (Mover& mover : movers_) mover.along = center_of(solve, mover.end)[axis];
  std::ranges::sort(movers_, {}, [](const Mover& m) { return std::pair(m.along, m.end); });
  for (const Mover& mover : movers_) {
    place_of_end[mover.end] = static_cast<Index>(mass_.size());
    if (mover.end < solve.model().free_count) {
      mass_.emplace_back(solve.model().mass[mover.end] * Mat3::Identity());
      continue;
    }
    const RigidMotion& motion = solve.rigid[mover.end - solve.model().free_count];
    mass_.emplace_back(Mat3::Identity() / motion.inverse_mass);
    mass_.push_back(inertia_of(motion.inverse_inertia));
  }
}

void ContactNewton::add_rows(const ContactSolve& solve,
                             std::span<const ContactConstraint> constraints,
                             std::span<const Index> island, std::span<const Real> excess,
                             std::span<const Index> place_of_end) {
  rows_.clear();
  for (std::size_t n = 0; n < island.size(); ++n) {
    const ContactConstraint& contact = constraints[island[n]];
    const Vec3 slip = solve.slip(contact);
    Row row{.sides = {},
            .normal = contact.normal,
            .slip = slip + (excess[n] - slip.dot(contact.normal)) * contact.normal,
            .mass = 1 / contact.mobility,
            .weight = 0,
            .limit = 0,
            .friction = contact.friction,
            .scale = solve.dt / contact.threshold,
            .multiplier = contact.impulse(),
            .at = Vec3::Zero(),
            .turn = Vec3::Zero()};
    for (const std::size_t side : {0U, 1U}) {
      const ContactEnd& end = contact.ends[side];
      if (end.inverse_mass == 0) continue;
      row.sides[side] = {place_of_end[number_of(solve, end)], end.rigid != kNoParticle, end.arm};
    }
    rows_.push_back(row);
  }
}

Vec3 ContactNewton::slip_by(const Row& row, std::span<const Vec3> change) {
  Vec3 slip = Vec3::Zero();
  Real sign = 1;
  for (const Side& side : row.sides) {
    if (side.block != kNoBlock) {
      slip += sign * change[side.block];
      if (side.turns) slip += sign * change[side.block + 1].cross(side.arm);
    }
    sign = -1;
  }
  return slip;
}

ContactNewton::Reply ContactNewton::reply(const Row& row, const Vec3& slip) {
  const Vec3 wanted = row.multiplier - row.weight * slip;
  const Real push = wanted.dot(row.normal);
  const Vec3 across = wanted - push * row.normal;
  const Mat3 along = row.normal * row.normal.transpose();
  Reply result{Vec3::Zero(), Mat3::Zero()};
  if (push > 0) {
    result.impulse = push * row.normal;
    result.slope = row.weight * along;
  }
  if (row.limit == 0) return result;
  const Real size = across.norm();
  const Mat3 plane = Mat3::Identity() - along;
  if (size <= row.limit) {
    result.impulse += across;
    result.slope += row.weight * plane;
    return result;
  }
  const Vec3 direction = across / size;
  result.impulse += row.limit * direction;
  result.slope += (row.weight * row.limit / size) * (plane - direction * direction.transpose());
  return result;
}

/// Returns the length of the Newton step at which the derivative of the energy along the step is
/// zero. The derivative increases with the length.
Real ContactNewton::find_length() const {
  constexpr int kMaxTrials = 40;
  constexpr Real kSmall = 1e-3;  // relative to the derivative at the start
  Real inertia = 0;
  Real start = 0;
  for (std::size_t k = 0; k < mass_.size(); ++k) {
    const Vec3 impulse = mass_[k] * newton_[k];
    inertia += impulse.dot(newton_[k]);
    start += impulse.dot(change_[k]);
  }
  const auto derivative = [&](Real length) {
    Real sum = start + length * inertia;
    for (const Row& row : rows_) {
      sum -= (reply(row, row.at + length * row.turn).impulse - row.multiplier).dot(row.turn);
    }
    return sum;
  };
  // The Illinois method: M. Dowell, P. Jarratt, BIT 11 (1971) 168.
  Real low = 0;
  Real high = 1;
  Real at_low = derivative(low);
  Real at_high = derivative(high);
  if (!(at_low < 0)) return 0;
  if (at_high <= 0) return high;
  const Real enough = -kSmall * at_low;
  int last_side = 0;
  for (int trial = 0; trial < kMaxTrials; ++trial) {
    const Real middle = (low * at_high - high * at_low) / (at_high - at_low);
    const Real value = derivative(middle);
    if (std::abs(value) <= enough) return middle;
    const int side = value < 0 ? -1 : 1;
    Real& kept = value < 0 ? at_high : at_low;
    if (side == last_side) kept /= 2;
    last_side = side;
    (value < 0 ? low : high) = middle;
    (value < 0 ? at_low : at_high) = value;
  }
  return low;
}

void ContactNewton::add_slope(const Row& row, const Mat3& slope) {
  for (const Side& a : row.sides) {
    for (const Side& b : row.sides) {
      if (a.block == kNoBlock || b.block == kNoBlock || a.block < b.block) continue;
      const Real sign = &a == &b ? 1 : -1;
      const Mat3 block = sign * slope;
      factor_.add(a.block, b.block, block);
      const Mat3 arm_a = a.turns ? cross_matrix(a.arm) : Mat3(Mat3::Zero());
      const Mat3 arm_b = b.turns ? cross_matrix(b.arm) : Mat3(Mat3::Zero());
      if (a.turns) factor_.add(a.block + 1, b.block, arm_a * block);
      if (b.turns && &a != &b) factor_.add(a.block, b.block + 1, -block * arm_b);
      if (a.turns && b.turns) factor_.add(a.block + 1, b.block + 1, -arm_a * block * arm_b);
    }
  }
}

/// Takes a Newton step that lowers the energy. Returns false if there is none.
bool ContactNewton::step() {
  factor_.clear(mass_.size(), width_);
  newton_.assign(mass_.size(), Vec3::Zero());
  for (std::size_t k = 0; k < mass_.size(); ++k) {
    factor_.add(k, k, mass_[k]);
    newton_[k] -= mass_[k] * change_[k];
  }
  for (Row& row : rows_) {
    row.at = row.slip + slip_by(row, change_);
    const Reply at = reply(row, row.at);
    add_slope(row, at.slope);
    const Vec3 impulse = at.impulse - row.multiplier;
    Real sign = 1;
    for (const Side& side : row.sides) {
      if (side.block != kNoBlock) {
        newton_[side.block] += sign * impulse;
        if (side.turns) newton_[side.block + 1] += sign * side.arm.cross(impulse);
      }
      sign = -1;
    }
  }
  if (!factor_.factor()) return false;
  factor_.solve(newton_);
  for (Row& row : rows_) row.turn = slip_by(row, newton_);
  const Real length = find_length();
  if (!(length > 0)) return false;
  for (std::size_t k = 0; k < change_.size(); ++k) change_[k] += length * newton_[k];
  return true;
}

/// Minimises the energy. Returns false if the steps do not converge.
bool ContactNewton::minimise() {
  change_.assign(mass_.size(), Vec3::Zero());
  for (int steps = 0; steps < kMaxSteps; ++steps) {
    if (!step()) return steps > 0;
    const bool is_small = std::ranges::all_of(
        rows_, [&](const Row& row) { return slip_by(row, newton_).norm() * row.scale <= kEnough; });
    if (is_small) return true;
  }
  return false;
}

std::size_t ContactNewton::prepare(const ContactSolve& solve,
                                   std::span<const ContactConstraint> constraints,
                                   std::span<const Index> island, std::span<Index> place_of_end) {
  // Costs on one core, relative to a round of sweeps, which takes about 125 ns per contact.
  constexpr Real kStepsOfRun = 12;
  constexpr Real kAssembly = 3;
  constexpr Real kBlockOfFactor = 0.07;
  place_movers(solve, constraints, island, place_of_end);
  width_ = 1;
  for (const Index c : island) {
    const auto& [first, second] = constraints[c].ends;
    if (first.inverse_mass == 0 || second.inverse_mass == 0) continue;
    const auto [low, high] =
        std::minmax(place_of_end[number_of(solve, first)], place_of_end[number_of(solve, second)]);
    width_ = std::max(width_, high - low + 1);
  }
  if (width_ > BandFactor::kMaxWidth) return kNever;
  const Real height = width_ + 1;
  const Real factor = kBlockOfFactor * height * height * static_cast<Real>(mass_.size()) /
                      static_cast<Real>(island.size());
  return static_cast<std::size_t>(kStepsOfRun * (kAssembly + factor));
}

void ContactNewton::run(ContactSolve& solve, std::span<ContactConstraint> constraints,
                        std::span<const Index> island, std::span<const Real> excess,
                        std::span<const Index> place_of_end) {
  VAT_CHECK(excess.size() == island.size());
  add_rows(solve, constraints, island, excess, place_of_end);
  Real weight = kFirstWeight;
  for (int round = 0; round < kMaxRounds; ++round, weight = std::min(100 * weight, kLastWeight)) {
    for (Row& row : rows_) {
      row.weight = weight * row.mass;
      row.limit = row.friction * std::max(Real{0}, row.multiplier.dot(row.normal));
    }
    if (!minimise()) break;
    Real greatest = 0;
    for (Row& row : rows_) {
      row.slip += slip_by(row, change_);
      // The impulse of the changed velocities; the slip at the old multiplier gave the change.
      const Vec3 impulse = reply(row, row.slip).impulse;
      // The multiplier changes by its weight times the violation of the constraint.
      const Real violation = (impulse - row.multiplier).norm() / row.weight;
      greatest = std::max(greatest, violation * row.scale);
      row.multiplier = impulse;
    }
    if (greatest <= kEnough) break;
  }
  for (std::size_t n = 0; n < island.size(); ++n) {
    ContactConstraint& contact = constraints[island[n]];
    solve.start_from(contact, rows_[n].multiplier - contact.impulse());
  }
}

}  // namespace vat
