#pragma once

#include <cstddef>
#include <limits>
#include <mutex>
#include <optional>
#include <utility>
#include <variant>

#include "server/support/limit_excess.h"

namespace vat {

/// Numbers of a simulation that determine its memory.
struct Resources {
  std::size_t particles = 0;
  std::size_t springs = 0;
};

/// No limit, for repeated logs: what was accepted before is accepted again.
inline constexpr Resources kUnlimitedResources{std::numeric_limits<std::size_t>::max() / 2,
                                               std::numeric_limits<std::size_t>::max() / 2};

class ResourceShare;

/// Particles and springs of all sessions together. Checks and takes them in one step. Safe to use
/// from any thread.
class ResourceBudget {
 public:
  explicit ResourceBudget(const Resources& most) : most_(most) {}

  std::variant<ResourceShare, LimitExcess> take(const Resources& wanted);
  /// Takes them even beyond the limits, for sessions from before the server's start.
  ResourceShare take_anyway(const Resources& wanted);
  Resources used() const;

 private:
  friend class ResourceShare;
  std::optional<LimitExcess> change(const Resources& from, const Resources& to);

  const Resources most_;
  mutable std::mutex mutex_;
  Resources used_;
};

/// Part of the budget, which must outlive it. Returned when it is destroyed.
class ResourceShare {
 public:
  ResourceShare(ResourceShare&& other) noexcept
      : budget_(std::exchange(other.budget_, nullptr)), amount_(other.amount_) {}
  ResourceShare& operator=(ResourceShare&& other) noexcept {
    std::swap(budget_, other.budget_);
    std::swap(amount_, other.amount_);
    return *this;
  }
  ~ResourceShare();

  const Resources& amount() const { return amount_; }
  /// Returns the limit if the amount does not fit, and changes nothing. A smaller amount always
  /// fits.
  std::optional<LimitExcess> resize(const Resources& amount);
  /// Resizes even beyond the limits.
  void resize_anyway(const Resources& amount);

 private:
  friend class ResourceBudget;
  ResourceShare(ResourceBudget& budget, const Resources& amount)
      : budget_(&budget), amount_(amount) {}

  ResourceBudget* budget_;  // null: moved from
  Resources amount_;
};

}  // namespace vat
