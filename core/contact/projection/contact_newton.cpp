#include "core/contact/projection/contact_newton.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/contact/projection/contact_solve.h"
#include "core/contact/projection/cross_matrix.h"
#include "core/support/check.h"

namespace vat {
namespace {

constexpr int kMaxRounds = 20;
constexpr Index kMaxSteps = 60;  // of a run; most runs of a stack need fewer than 20
// Weights of a multiplier, relative to the mass of its contact. The last one exceeds the inertia of
// a tall stack that rocks about an edge, relative to that of its lowest contacts: about the number
// of bodies times the squared ratio of height and width.
constexpr Real kFirstWeight = 1e3;
constexpr Real kLastWeight = 1e8;
constexpr Real kWeightFactor = 1e3;
// If a round does not decrease the violation by this factor, the weight increases.
constexpr Real kSlow = 0.1;
// Residual at which a round ends, relative to the violation of the constraints.
constexpr Real kInexact = 0.01;
// Displacement in a step, in thresholds. It is far below the tolerance of the sweeps, because the
// impulses are those with which the next steps start.
constexpr Real kEnough = 1e-10;

Index number_of(const ContactSolve& solve, const ContactEnd& end) {
  return end.rigid == kNoParticle ? end.particle : solve.model().free_count + end.rigid;
}

const Vec3& center_of(const ContactSolve& solve, Index end) {
  const Index free_count = solve.model().free_count;
  return end < free_count ? solve.at.position[end]
                          : solve.at.rigid[end - free_count].center_of_mass;
}

}  // namespace

/// Adds a block with the inverse of an inverse mass or inertia. Axes about which the body cannot
/// turn get a unit inertia.
void ContactNewton::add_block(Mat3 inverse_mass) {
  inverse_mass_.push_back(inverse_mass);
  for (int k = 0; k < 3; ++k) {
    if (inverse_mass(k, k) == 0) inverse_mass(k, k) = 1;
  }
  mass_.emplace_back(inverse_mass.inverse());
}

void ContactNewton::place_movers(const ContactSolve& solve,
                                 std::span<const ContactConstraint> constraints,
                                 std::span<const Index> island, std::span<Index> place_of_end) {
  movers_.clear();
  mass_.clear();
  inverse_mass_.clear();
  for (const Index c : island) {
    for (const ContactEnd& end : constraints[c].ends) {
      if (end.inverse_mass > 0) place_of_end[number_of(solve, end)] = ContactRow::kNoBlock;
    }
  }
  Vec3 low = Vec3::Constant(std::numeric_limits<Real>::infinity());
  Vec3 high = -low;
  for (const Index c : island) {
    for (const ContactEnd& end : constraints[c].ends) {
      const Index number = number_of(solve, end);
      if (end.inverse_mass == 0 || place_of_end[number] != ContactRow::kNoBlock) continue;
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
      add_block(solve.model().inverse_mass[mover.end] * Mat3::Identity());
      continue;
    }
    const RigidMotion& motion = solve.rigid[mover.end - solve.model().free_count];
    add_block(motion.inverse_mass * Mat3::Identity());
    add_block(motion.inverse_inertia);
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
    ContactRow row{.contact = island[n],
                   .sides = {},
                   .normal = contact.normal,
                   .slip = slip + (excess[n] - slip.dot(contact.normal)) * contact.normal,
                   .mass = 1 / contact.mobility,
                   .weight = 0,
                   .friction = contact.friction,
                   .lift = 0,
                   .has_limit = has_limits_,
                   .limit = contact.friction * contact.push,
                   .scale = solve.dt / contact.threshold,
                   .multiplier = contact.impulse(),
                   .at = Vec3::Zero(),
                   .turn = Vec3::Zero(),
                   .impulse = Vec3::Zero()};
    for (const std::size_t side : {0U, 1U}) {
      const ContactEnd& end = contact.ends[side];
      if (end.inverse_mass == 0) continue;
      row.sides[side] = {place_of_end[number_of(solve, end)], end.rigid != kNoParticle, end.arm};
    }
    rows_.push_back(row);
  }
  const auto pair = [](const ContactRow& row) {
    return std::pair(row.sides[0].block, row.sides[1].block);
  };
  std::ranges::stable_sort(rows_, {}, pair);
}

Vec3 ContactNewton::slip_by(const ContactRow& row, std::span<const Vec3> change) {
  Vec3 slip = Vec3::Zero();
  Real sign = 1;
  for (const ContactRow::Side& side : row.sides) {
    if (side.block != ContactRow::kNoBlock) {
      slip += sign * change[side.block];
      if (side.turns) slip += sign * change[side.block + 1].cross(side.arm);
    }
    sign = -1;
  }
  return slip;
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
    for (const ContactRow& row : rows_) {
      sum -= (impulse_at(row, row.at + length * row.turn) - row.multiplier).dot(row.turn);
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

/// Adds the slopes of contacts between the same movers.
void ContactNewton::add_slopes(std::span<const ContactRow> rows) {
  const std::array<ContactRow::Side, 2>& sides = rows.front().sides;
  Mat3 slope = Mat3::Zero();
  std::array<Mat3, 2> turned = {Mat3::Zero(), Mat3::Zero()};  // by side: arm x slope
  std::array<Mat3, 2> twice = turned;                         // by side: arm x slope x arm
  Mat3 both = Mat3::Zero();                                   // first arm x slope x second arm
  for (const ContactRow& row : rows) {
    if (row.impulse.isZero(0)) continue;
    const Mat3 own = slope_at(row, row.at);
    slope += own;
    for (const std::size_t side : {0U, 1U}) {
      if (!sides[side].turns) continue;
      const Mat3 cross = cross_matrix(row.sides[side].arm);
      const Mat3 moment = cross * own;
      turned[side] += moment;
      twice[side] -= moment * cross;
      if (side == 0 && sides[1].turns) both -= moment * cross_matrix(row.sides[1].arm);
    }
  }
  for (const std::size_t side : {0U, 1U}) {
    const Index block = sides[side].block;
    if (block == ContactRow::kNoBlock) continue;
    factor_.add(block, block, slope);
    if (!sides[side].turns) continue;
    factor_.add(block + 1, block, turned[side]);
    factor_.add(block + 1, block + 1, twice[side]);
  }
  const Index first = sides[0].block;
  const Index second = sides[1].block;
  if (first == ContactRow::kNoBlock || second == ContactRow::kNoBlock) return;
  factor_.add(first, second, -slope);
  if (sides[0].turns) factor_.add(first + 1, second, -turned[0]);
  if (sides[1].turns) factor_.add(first, second + 1, -turned[1].transpose());
  if (sides[0].turns && sides[1].turns) factor_.add(first + 1, second + 1, -both);
}

/// Sets the impulse of each contact and the residual, which is the derivative of the energy with
/// the opposite sign. Returns the greatest displacement that the residual would cause between the
/// ends of a contact, in thresholds.
Real ContactNewton::find_residual() {
  for (std::size_t k = 0; k < mass_.size(); ++k) newton_[k] = -(mass_[k] * change_[k]);
  for (ContactRow& row : rows_) {
    row.at = row.slip + slip_by(row, change_);
    row.impulse = impulse_at(row, row.at);
    const Vec3 impulse = row.impulse - row.multiplier;
    Real sign = 1;
    for (const ContactRow::Side& side : row.sides) {
      if (side.block != ContactRow::kNoBlock) {
        newton_[side.block] += sign * impulse;
        if (side.turns) newton_[side.block + 1] += sign * side.arm.cross(impulse);
      }
      sign = -1;
    }
  }
  for (std::size_t k = 0; k < mass_.size(); ++k) speed_[k] = inverse_mass_[k] * newton_[k];
  Real greatest = 0;
  for (const ContactRow& row : rows_) {
    greatest = std::max(greatest, row.scale * slip_by(row, speed_).norm());
  }
  return greatest;
}

/// Takes a Newton step that lowers the energy. Returns false if there is none.
bool ContactNewton::step() {
  factor_.clear(mass_.size(), width_);
  for (std::size_t k = 0; k < mass_.size(); ++k) factor_.add(k, k, mass_[k]);
  for (std::size_t begin = 0, end = 0; begin < rows_.size(); begin = end) {
    const auto is_same = [&](std::size_t n) {
      return rows_[n].sides[0].block == rows_[begin].sides[0].block &&
             rows_[n].sides[1].block == rows_[begin].sides[1].block;
    };
    while (end < rows_.size() && is_same(end)) ++end;
    add_slopes(std::span(rows_).subspan(begin, end - begin));
  }
  if (!factor_.factor()) return false;
  factor_.solve(newton_);
  for (ContactRow& row : rows_) row.turn = slip_by(row, newton_);
  const Real length = find_length();
  if (!(length > 0)) return false;
  for (std::size_t k = 0; k < change_.size(); ++k) change_[k] += length * newton_[k];
  return true;
}

/// Returns the greatest violation of a constraint by the present impulses, as a displacement in
/// thresholds.
Real ContactNewton::violation() const {
  Real greatest = 0;
  for (const ContactRow& row : rows_) {
    greatest = std::max(greatest, row.scale * (row.impulse - row.multiplier).norm() / row.weight);
  }
  return greatest;
}

/// Decreases the energy. Returns whether the residual has become small compared with the violation.
bool ContactNewton::minimise() {
  change_.assign(mass_.size(), Vec3::Zero());
  newton_.resize(mass_.size());
  speed_.resize(mass_.size());
  while (find_residual() > std::max(kEnough, kInexact * violation())) {
    if (steps_ == kMaxSteps) return false;
    ++steps_;
    // Near the minimum, rounding may leave no step that decreases the energy.
    if (!step()) return false;
  }
  return true;
}

/// Sets slips, multipliers, and lifts or limits to those of the minimum. Returns the greatest
/// displacement by which a constraint was violated, in thresholds.
Real ContactNewton::update_multipliers() {
  Real greatest = 0;
  for (ContactRow& row : rows_) {
    row.slip += slip_by(row, change_);
    greatest = std::max(greatest, row.scale * update(row));
  }
  return greatest;
}

Real ContactNewton::find_width(const ContactSolve& solve,
                               std::span<const ContactConstraint> constraints,
                               std::span<const Index> island, std::span<const Index> place_of_end) {
  width_ = 1;
  Real fastest = 0;
  for (const Index c : island) {
    const ContactConstraint& contact = constraints[c];
    if (contact.push > 0) {
      const Vec3 slip = solve.slip(contact);
      const Vec3 across = slip - slip.dot(contact.normal) * contact.normal;
      fastest = std::max(fastest, contact.friction * across.norm() * solve.dt / contact.threshold);
    }
    const auto& [first, second] = contact.ends;
    if (first.inverse_mass == 0 || second.inverse_mass == 0) continue;
    const auto [low, high] =
        std::minmax(place_of_end[number_of(solve, first)], place_of_end[number_of(solve, second)]);
    width_ = std::max(width_, high - low + 1);
  }
  return fastest;
}

std::size_t ContactNewton::prepare(const ContactSolve& solve,
                                   std::span<const ContactConstraint> constraints,
                                   std::span<const Index> island, std::span<Index> place_of_end) {
  // If a contact slides faster, in thresholds per step and times its friction, nine of ten runs for
  // a wall of bricks do not converge: the lifts and the impulses change each other.
  constexpr Real kFastest = 1e-3;
  // Costs on one core, relative to a round of sweeps. More contacts change their state in a wide
  // island, which takes more steps.
  constexpr Real kStepsPerHeight = 2;
  constexpr Real kAssembly = 2;
  constexpr Real kBlockOfFactor = 0.07;
  place_movers(solve, constraints, island, place_of_end);
  const Real fastest = find_width(solve, constraints, island, place_of_end);
  has_limits_ = fastest > kFastest;
  if (width_ > BandFactor::kMaxWidth) return kNever;
  const Real height = width_ + 1;
  const Real factor = kBlockOfFactor * height * height * static_cast<Real>(mass_.size()) /
                      static_cast<Real>(island.size());
  return static_cast<std::size_t>(kStepsPerHeight * height * (kAssembly + factor));
}

std::size_t ContactNewton::run(ContactSolve& solve, std::span<ContactConstraint> constraints,
                               std::span<const Index> island, std::span<const Real> excess,
                               std::span<const Index> place_of_end) {
  VAT_CHECK(excess.size() == island.size());
  add_rows(solve, constraints, island, excess, place_of_end);
  steps_ = 0;
  Real weight = kFirstWeight;
  Real last = std::numeric_limits<Real>::infinity();
  for (int round = 0; round < kMaxRounds; ++round) {
    for (ContactRow& row : rows_) row.weight = weight * row.mass;
    if (!minimise()) break;
    const Real violation = update_multipliers();
    if (violation <= kEnough) break;
    if (violation > kSlow * last) weight = std::min(kWeightFactor * weight, kLastWeight);
    last = violation;
  }
  for (const ContactRow& row : rows_) {
    ContactConstraint& contact = constraints[row.contact];
    solve.start_from(contact, row.multiplier - contact.impulse());
  }
  return steps_;
}

}  // namespace vat
