#include "core/solid/elongation_limit.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "core/support/check.h"

namespace vat {
namespace {

using Limit = ElongationScratch::Limit;

/// The impulses of all limited springs in one step.
class LimitSolve {
 public:
  LimitSolve(const Model& model, TaskRunner* runner, Configuration& at, Real dt,
             ElongationScratch& scratch)
      : model_(model), runner_(runner), at_(at), dt_(dt), scratch_(scratch) {}

  void set_geometry();
  /// Changes the impulses of all springs in order and in reverse order. Returns whether the change
  /// of a spring exceeds the tolerance.
  bool sweep();
  /// Extrapolates the impulses of the last sweeps. The results may violate the limits. The next
  /// sweep corrects them.
  void extrapolate();

 private:
  template <class F>
  void for_colour(std::size_t colour, F&& f);
  Real separating_speed(const LimitedSpring& spring, const Limit& limit) const {
    return (at_.velocity[spring.a] - at_.velocity[spring.b]).dot(limit.direction);
  }
  void pull(const LimitedSpring& spring, const Limit& limit, Real impulse);
  bool relax(std::size_t index);

  const Model& model_;
  TaskRunner* runner_;
  Configuration& at_;
  Real dt_;
  ElongationScratch& scratch_;
  Real last_size_ = 0;  ///< squared norm of the preceding gradients
};

/// Calls f(index) for the springs of a colour, in parallel.
template <class F>
void LimitSolve::for_colour(std::size_t colour, F&& f) {
  const Index first = model_.limited_begin[colour];
  for_blocks(runner_, model_.limited_begin[colour + 1] - first,
             [&](std::size_t begin, std::size_t end) {
               for (std::size_t k = begin; k < end; ++k) f(first + k);
             });
}

void LimitSolve::set_geometry() {
  scratch_.limits.resize(model_.limited_springs.size());
  for_blocks(runner_, scratch_.limits.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const LimitedSpring& spring = model_.limited_springs[k];
      const bool is_torn = !at_.springs.empty() && at_.springs[spring.end].is_torn;
      const Vec3 x = at_.position[spring.a] - at_.position[spring.b];
      const Real length = x.norm();
      const Real mobility = model_.inverse_mass[spring.a] + model_.inverse_mass[spring.b];
      VAT_ASSERT(mobility > 0);
      const bool acts = !is_torn && length > 0;
      scratch_.limits[k] = {acts ? Vec3(x / length) : Vec3(Vec3::Zero()),
                            (spring.greatest - length) / dt_,
                            acts ? 1 / mobility : 0,
                            0,
                            0,
                            0};
    }
  });
}

void LimitSolve::pull(const LimitedSpring& spring, const Limit& limit, Real impulse) {
  at_.velocity[spring.a] -= (model_.inverse_mass[spring.a] * impulse) * limit.direction;
  at_.velocity[spring.b] += (model_.inverse_mass[spring.b] * impulse) * limit.direction;
}

/// Changes the impulse of a spring so that the spring reaches its limit, or is free. Returns
/// whether the change exceeds the tolerance.
bool LimitSolve::relax(std::size_t index) {
  const LimitedSpring& spring = model_.limited_springs[index];
  Limit& limit = scratch_.limits[index];
  const Real excess = separating_speed(spring, limit) - limit.free_speed;
  const Real change = std::max(-limit.impulse, limit.mass * excess);
  if (limit.mass == 0 || change == 0) return false;
  limit.impulse += change;
  pull(spring, limit, change);
  return std::abs(change) * dt_ > kElongationTolerance * spring.greatest * limit.mass;
}

bool LimitSolve::sweep() {
  std::atomic<bool> has_changed = false;
  const std::size_t colours = model_.limited_begin.size() - 1;
  const auto relax_colour = [&](std::size_t colour) {
    for_colour(colour, [&](std::size_t k) {
      if (relax(k)) has_changed.store(true, std::memory_order_relaxed);
    });
  };
  for (Limit& limit : scratch_.limits) limit.gradient = -limit.impulse;
  for (std::size_t colour = 0; colour < colours; ++colour) relax_colour(colour);
  for (std::size_t colour = colours; colour-- > 0;) relax_colour(colour);
  return has_changed;
}

void LimitSolve::extrapolate() {
  std::vector<Real>& sums = scratch_.partial_sums;
  sums.assign(block_count(scratch_.limits.size()), 0);
  for_blocks(runner_, scratch_.limits.size(), [&](std::size_t begin, std::size_t end) {
    Real sum = 0;
    for (std::size_t k = begin; k < end; ++k) {
      Limit& limit = scratch_.limits[k];
      limit.gradient += limit.impulse;
      sum += limit.gradient * limit.gradient;
    }
    sums[begin / kBlockSize] = sum;
  });
  Real size = 0;
  for (const Real sum : sums) size += sum;
  const Real share = size < last_size_ ? size / last_size_ : 0;
  last_size_ = size;
  for (std::size_t colour = 0; colour + 1 < model_.limited_begin.size(); ++colour) {
    for_colour(colour, [&](std::size_t k) {
      Limit& limit = scratch_.limits[k];
      const Real change = share * limit.search;
      limit.search = change + limit.gradient;
      if (change == 0) return;
      limit.impulse += change;
      pull(model_.limited_springs[k], limit, change);
    });
  }
}

}  // namespace

int limit_elongation(const Model& model, TaskRunner* runner, Configuration& at, Real dt,
                     ElongationScratch& scratch) {
  if (model.limited_springs.empty()) return 0;
  VAT_CHECK(dt > 0 && at.velocity.size() == model.particle_count);
  LimitSolve solve(model, runner, at, dt, scratch);
  solve.set_geometry();
  int sweeps = 2;
  for (; solve.sweep() && sweeps < kElongationSweeps; sweeps += 2) solve.extrapolate();
  return sweeps;
}

}  // namespace vat
