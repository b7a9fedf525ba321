#include "server/support/resource_budget.h"
#include "core/support/check.h"

namespace vat {
namespace {

/// Whether `used` exceeds `most` after `from` becomes `to`. A decrease is always allowed.
bool passes(std::size_t used, std::size_t from, std::size_t to, std::size_t most) {
  return to > from && used - from + to > most;
}

}  // namespace

std::variant<ResourceShare, LimitExcess> ResourceBudget::take(const Resources& wanted) {
  if (const auto excess = change({}, wanted)) return *excess;
  return ResourceShare(*this, wanted);
}

ResourceShare ResourceBudget::take_anyway(const Resources& wanted) {
  const std::lock_guard lock(mutex_);
  used_.particles += wanted.particles;
  used_.springs += wanted.springs;
  return {*this, wanted};
}

Resources ResourceBudget::used() const {
  const std::lock_guard lock(mutex_);
  return used_;
}

std::optional<LimitExcess> ResourceBudget::change(const Resources& from, const Resources& to) {
  const std::lock_guard lock(mutex_);
  VAT_CHECK(used_.particles >= from.particles && used_.springs >= from.springs);
  if (passes(used_.particles, from.particles, to.particles, most_.particles)) {
    return LimitExcess{"particles_in_all", most_.particles};
  }
  if (passes(used_.springs, from.springs, to.springs, most_.springs)) {
    return LimitExcess{"springs_in_all", most_.springs};
  }
  used_.particles += to.particles - from.particles;  // modulo 2^64, so that decreases work too
  used_.springs += to.springs - from.springs;
  return {};
}

ResourceShare::~ResourceShare() {
  if (budget_ != nullptr) budget_->change(amount_, {});
}

std::optional<LimitExcess> ResourceShare::resize(const Resources& amount) {
  VAT_CHECK(budget_ != nullptr);
  if (auto excess = budget_->change(amount_, amount)) return excess;
  amount_ = amount;
  return {};
}

void ResourceShare::resize_anyway(const Resources& amount) {
  *this = budget_->take_anyway(amount);
}

}  // namespace vat
