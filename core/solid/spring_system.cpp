#include "core/solid/spring_system.h"

#include <algorithm>
#include <limits>

#include "core/support/check.h"

namespace vat {
namespace {

constexpr int kMaxPasses = 1000;
constexpr Real kFactorCost = 0.5;  // of one block of the band, in products of one spring end

}  // namespace

void SpringSystemScratch::resize(const Model& model) {
  VAT_CHECK(model.implicit_begin <= model.free_count);
  const std::size_t count = model.free_count - model.implicit_begin;
  for (auto* column : {&residual, &change, &remaining, &preconditioned, &direction, &product})
    column->resize(count);
  slopes.resize(model.spring_ends.size() - model.spring_begin[model.implicit_begin]);
}

int spring_factor_cost(const Model& model, const ModelBody& body) {
  if (!body.spring_width) return 0;
  const IndexRange& particles = body.particles;
  const Real ends = model.spring_begin[particles.end] - model.spring_begin[particles.begin];
  const Real height = *body.spring_width + 1;
  const Real band = height * height * particles.size();
  return static_cast<int>(kFactorCost * band / std::max(ends, Real{1}));
}

SpringSystem::SpringSystem(const Model& model, TaskRunner* runner, const ModelBody& body,
                           SpringSystemScratch& scratch)
    : model_(model),
      runner_(runner),
      particles_(body.particles),
      width_(body.spring_width),
      scratch_(scratch),
      factor_cost_(spring_factor_cost(model, body)) {
  for (Index i = particles_.begin; i < particles_.end; ++i) {
    if (model_.inverse_mass[i] == 0) {
      free_mass_ = 0;
      break;
    }
    free_mass_ += model_.mass[i];
  }
}

/// Computes the Cholesky factor of M + slopes. Rounding may prevent it.
void SpringSystem::factor() {
  BandFactor& matrix = scratch_.factor;
  matrix.clear(particles_.size(), *width_);
  for (Index i = particles_.begin; i < particles_.end; ++i) {
    const Index place = model_.implicit_places[place_of(i)];
    if (model_.inverse_mass[i] == 0) {  // its row is that of the unit matrix
      matrix.add(place, place, Mat3::Identity());
      continue;
    }
    Mat3 diagonal = model_.mass[i] * Mat3::Identity();
    for (Index e = model_.spring_begin[i]; e < model_.spring_begin[i + 1]; ++e) {
      const SpringSlope& s = slope(e);
      const Mat3 block = s.across * Mat3::Identity() +
                         (s.along - s.across) * s.direction * s.direction.transpose();
      diagonal += block;
      const Index other = model_.spring_ends[e].other;
      if (other < i && model_.inverse_mass[other] > 0) {
        matrix.add(place, model_.implicit_places[place_of(other)], -block);
      }
    }
    matrix.add(place, place, diagonal);
  }
  is_factored_ = matrix.factor();
}

bool SpringSystem::stop_factoring() {
  const bool could = width_.has_value();
  width_.reset();
  is_factored_ = false;
  return could;
}

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

Real SpringSystem::size_of_remaining() {
  return sum([&](Index i) {
    return model_.inverse_mass[i] * scratch_.remaining[place_of(i)].squaredNorm();
  });
}

/// preconditioned = solution of the factor for `remaining`. Rounding errors of stiff springs do not
/// change the momentum of a body without fixed particles.
void SpringSystem::apply_factor() {
  scratch_.ordered.resize(particles_.size());
  Vec3 momentum = Vec3::Zero();
  for (Index i = particles_.begin; i < particles_.end; ++i) {
    const std::size_t k = place_of(i);
    scratch_.ordered[model_.implicit_places[k]] = scratch_.remaining[k];
    momentum += scratch_.remaining[k];
  }
  scratch_.factor.solve(scratch_.ordered);
  for (Index i = particles_.begin; i < particles_.end; ++i) {
    const std::size_t k = place_of(i);
    scratch_.preconditioned[k] = scratch_.ordered[model_.implicit_places[k]];
    momentum -= model_.mass[i] * scratch_.preconditioned[k];
  }
  if (free_mass_ == 0) return;
  const Vec3 missing = momentum / free_mass_;
  for (Index i = particles_.begin; i < particles_.end; ++i) {
    scratch_.preconditioned[place_of(i)] += missing;
  }
}

void SpringSystem::precondition() {
  if (is_factored_) {
    apply_factor();
    return;
  }
  for_particles([&](Index i) {
    scratch_.preconditioned[place_of(i)] = model_.inverse_mass[i] * scratch_.remaining[place_of(i)];
  });
}

/// Returns false if the residual is too large after `limit` iterations.
bool SpringSystem::iterate(Real enough, int limit) {
  std::vector<Vec3>& remaining = scratch_.remaining;
  std::vector<Vec3>& direction = scratch_.direction;
  const auto slope_along = [&](const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    return sum([&](Index i) { return a[place_of(i)].dot(b[place_of(i)]); });
  };
  for_particles([&](Index i) { direction[place_of(i)].setZero(); });
  Real last = std::numeric_limits<Real>::infinity();
  for (int iteration = 0; iteration < limit; ++iteration) {
    precondition();
    const Real next = slope_along(remaining, scratch_.preconditioned);
    const Real kept = next / last;
    for_particles([&](Index i) {
      const std::size_t k = place_of(i);
      direction[k] = scratch_.preconditioned[k] + kept * direction[k];
    });
    last = next;
    multiply();
    if (!is_factored_) ++iterations_;
    const Real curvature = slope_along(direction, scratch_.product);
    if (!(curvature > 0)) return true;  // too small for the precision of numbers
    const Real length = next / curvature;
    for_particles([&](Index i) {
      const std::size_t k = place_of(i);
      scratch_.change[k] += length * direction[k];
      remaining[k] -= length * scratch_.product[k];
    });
    if (size_of_remaining() <= enough) return true;
  }
  return false;
}

void SpringSystem::solve(Real tolerance) {
  VAT_CHECK(scratch_.residual.size() == model_.free_count - model_.implicit_begin);
  VAT_CHECK(scratch_.change.size() == scratch_.residual.size() &&
            scratch_.product.size() == scratch_.residual.size());
  for_particles([&](Index i) {
    scratch_.change[place_of(i)].setZero();
    scratch_.remaining[place_of(i)] = scratch_.residual[place_of(i)];
  });
  const Real size = size_of_remaining();
  if (size == 0) return;
  const Real enough = tolerance * tolerance * size;
  if (width_) {
    if (!is_factored_ && iterate(enough, factor_cost_ - iterations_)) return;
    // The factor of earlier slopes remains useful if these are similar.
    if (is_factored_ && iterate(enough, factor_cost_ / 2 + 1)) return;
    factor();
  }
  iterate(enough, kMaxPasses);
}

}  // namespace vat
