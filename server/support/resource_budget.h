#pragma once

#include <cstddef>
#include <limits>
#include <mutex>
#include <optional>
#include <utility>
#include <variant>

#include "server/support/limit_excess.h"

namespace vat {

/// Properties of a simulation that determine its memory.
struct Resources {
  std::size_t particles = 0;
  std::size_t springs = 0;
};

/// No limit. Recoveries and replays use the value to accept all previously accepted commands.
inline constexpr Resources kUnlimitedResources{std::numeric_limits<std::size_t>::max() / 2,
                                               std::numeric_limits<std::size_t>::max() / 2};

class ResourceShare;

/// Budget for the particles and springs of all sessions. A check and the reservation are one atomic
/// operation. Thread-safe.
class ResourceBudget {
 public:
  explicit ResourceBudget(const Resources& most) : most_(most) {}

  std::variant<ResourceShare, LimitExcess> take(const Resources& wanted);
  /// Reserves resources even beyond the limits, for sessions from an earlier run of the server.
  ResourceShare take_anyway(const Resources& wanted);
  Resources used() const;

 private:
  friend class ResourceShare;
  std::optional<LimitExcess> change(const Resources& from, const Resources& to);

  const Resources most_;
  mutable std::mutex mutex_;
  Resources used_;
};

/// Reserved part of a budget. The destructor returns the part. The budget must outlive the share.
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
  /// Changes the amount. If a limit would be exceeded, returns the limit and changes nothing. A
  /// smaller amount never exceeds a limit.
  std::optional<LimitExcess> resize(const Resources& amount);
  /// Changes the amount, even beyond the limits.
  void resize_anyway(const Resources& amount);

 private:
  friend class ResourceBudget;
  ResourceShare(ResourceBudget& budget, const Resources& amount)
      : budget_(&budget), amount_(amount) {}

  ResourceBudget* budget_;  // null: moved from
  Resources amount_;
};

}  // namespace vat
