#include "core/solid/spring_system.h"
#include "core/support/check.h"

namespace vat {
namespace {

constexpr int kMaxPasses = 1000;

}  // namespace

void SpringSystemScratch::resize(const Model& model) {
  VAT_CHECK(model.implicit_begin <= model.free_count);
  const std::size_t count = model.free_count - model.implicit_begin;
  for (auto* column : {&residual, &change, &remaining, &direction, &product}) column->resize(count);
  slopes.resize(model.spring_ends.size() - model.spring_begin[model.implicit_begin]);
}

SpringSystem::SpringSystem(const Model& model, TaskRunner* runner, const IndexRange& particles,
                           SpringSystemScratch& scratch)
    : model_(model), runner_(runner), particles_(particles), scratch_(scratch) {}

/// product = (M + slopes) direction.
void SpringSystem::multiply() {
  count_pass();
  const std::vector<Vec3>& p = scratch_.direction;
  for_particles([&](Index i) {
    const std::size_t k = place_of(i);
    Vec3 sum = Vec3::Zero();
    if (model_.inverse_mass[i] > 0) {
      sum = model_.mass[i] * p[k];
      for (Index e = model_.spring_begin[i]; e < model_.spring_begin[i + 1]; ++e) {
        VAT_CHECK(model_.spring_ends[e].other >= model_.implicit_begin);
        const SpringSlope& s = slope(e);
        const Vec3 d = p[k] - p[place_of(model_.spring_ends[e].other)];
        sum += s.across * d + ((s.along - s.across) * s.direction.dot(d)) * s.direction;
      }
    }
    scratch_.product[k] = sum;
  });
}

void SpringSystem::solve(Real tolerance) {
  const std::vector<Vec3>& residual = scratch_.residual;
  std::vector<Vec3>& change = scratch_.change;
  std::vector<Vec3>& remaining = scratch_.remaining;
  std::vector<Vec3>& direction = scratch_.direction;
  const std::vector<Vec3>& product = scratch_.product;
  VAT_CHECK(residual.size() == model_.free_count - model_.implicit_begin);
  VAT_CHECK(change.size() == residual.size() && product.size() == residual.size());
  for_particles([&](Index i) {
    const std::size_t k = place_of(i);
    change[k].setZero();
    remaining[k] = residual[k];
    direction[k] = model_.inverse_mass[i] * remaining[k];
  });
  const auto size_of_left = [&] {
    return sum(
        [&](Index i) { return model_.inverse_mass[i] * remaining[place_of(i)].squaredNorm(); });
  };
  Real size = size_of_left();
  const Real enough = tolerance * tolerance * size;
  for (int iteration = 0; iteration < kMaxPasses && size > enough; ++iteration) {
    multiply();
    const Real curvature =
        sum([&](Index i) { return direction[place_of(i)].dot(product[place_of(i)]); });
    if (!(curvature > 0)) return;  // too small for the precision of numbers
    const Real length = size / curvature;
    for_particles([&](Index i) {
      const std::size_t k = place_of(i);
      change[k] += length * direction[k];
      remaining[k] -= length * product[k];
    });
    const Real next = size_of_left();
    for_particles([&](Index i) {
      const std::size_t k = place_of(i);
      direction[k] = model_.inverse_mass[i] * remaining[k] + (next / size) * direction[k];
    });
    size = next;
  }
}

}  // namespace vat
