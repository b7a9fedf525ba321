#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/model/model.h"
#include "core/numerics/band_factor.h"
#include "core/support/check.h"
#include "core/support/parallel.h"

namespace vat {

/// Derivative of a spring's impulse on one of its ends with respect to the velocities [kg].
struct SpringSlope {
  Vec3 direction;
  Real along;
  Real across;
};

/// Buffers of SpringSystem, for the particles and spring ends from Model::implicit_begin on.
struct SpringSystemScratch {
  std::vector<SpringSlope> slopes;
  std::vector<Vec3> residual;   ///< impulses [N s]; zero for fixed particles
  std::vector<Vec3> change;     ///< change of velocities
  std::vector<Vec3> remaining;  ///< residual after the preceding iterations
  std::vector<Vec3> preconditioned;
  std::vector<Vec3> direction;
  std::vector<Vec3> product;
  std::vector<Real> partial_sums;  ///< indexed by block
  BandFactor factor;
  std::vector<Vec3> ordered;  ///< by place in the order of the factor

  void resize(const Model& model);
};

/// Returns the cost of the Cholesky factor of SpringSystem for a body, in iterations without a
/// factor. The cost of a body that is too wide for a factor is 0.
int spring_factor_cost(const Model& model, const ModelBody& body);

/// Linear equations (M + slopes) change = residual for the velocities of one body with implicit
/// springs. Slopes are equal at both ends, with opposite effects. Every solution therefore
/// conserves linear momentum. Angular momentum is also conserved if the slopes have no transverse
/// part.
class SpringSystem {
 public:
  SpringSystem(const Model& model, TaskRunner* runner, const ModelBody& body,
               SpringSystemScratch& scratch);

  /// Solves the equations by conjugate gradients, until the M^-1 norm of the residual is at most
  /// `tolerance` times its initial value. The preconditioner is M. For a narrow body, it becomes
  /// the Cholesky factor of M + slopes as soon as the iterations have cost as much as the factor.
  /// It is kept while the slopes change, as long as the iterations remain few. If rounding limits
  /// the accuracy, the solve ends after a limited number of iterations.
  void solve(Real tolerance);
  /// From now on, the preconditioner is M. Returns false if it already was.
  bool stop_factoring();

  /// Returns the number of passes over all springs of the body.
  std::uint64_t passes() const { return passes_; }
  void count_pass() { ++passes_; }

  std::size_t place_of(Index particle) const { return particle - model_.implicit_begin; }
  SpringSlope& slope(Index end) {
    VAT_CHECK(end - model_.spring_begin[model_.implicit_begin] < scratch_.slopes.size());
    return scratch_.slopes[end - model_.spring_begin[model_.implicit_begin]];
  }

  /// Calls f(particle) for each particle, in parallel.
  template <class F>
  void for_particles(F&& f) {
    for_blocks(runner_, particles_.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) f(particles_.begin + static_cast<Index>(k));
    });
  }
  /// Returns the sum of f(particle), in an order that depends only on the body.
  template <class F>
  Real sum(F&& f) {
    std::vector<Real>& sums = scratch_.partial_sums;
    sums.assign(block_count(particles_.size()), 0);
    for_blocks(runner_, particles_.size(), [&](std::size_t begin, std::size_t end) {
      Real part = 0;
      for (std::size_t k = begin; k < end; ++k) part += f(particles_.begin + static_cast<Index>(k));
      sums[begin / kBlockSize] = part;
    });
    Real total = 0;
    for (const Real part : sums) total += part;
    return total;
  }

 private:
  void multiply();
  Real size_of_remaining();
  void factor();
  void precondition();
  void apply_factor();
  bool iterate(Real enough, int limit);

  const Model& model_;
  TaskRunner* runner_;
  IndexRange particles_;
  std::optional<Index> width_;
  SpringSystemScratch& scratch_;
  const int factor_cost_;  ///< in iterations without a factor
  int iterations_ = 0;     ///< without a factor
  bool is_factored_ = false;
  Real free_mass_ = 0;  ///< [kg]; 0 if a particle is fixed
  std::uint64_t passes_ = 0;
};

}  // namespace vat
