#pragma once

#include <cstddef>
#include <limits>
#include <mutex>
#include <optional>
#include <string_view>
#include <utility>
#include <variant>

namespace vat {

/// What a simulation takes of the machine's memory.
struct Resources {
  std::size_t particles = 0;
  std::size_t springs = 0;
};

/// More than there can be, for a history that is carried out again: what was once allowed is so
/// then.
inline constexpr Resources kUnlimitedResources{std::numeric_limits<std::size_t>::max() / 2,
                                               std::numeric_limits<std::size_t>::max() / 2};

/// The limit that a wish would pass.
struct ResourceExcess {
  std::string_view limit;  ///< the name in server.info's `limits`
  std::size_t maximum = 0;
};

class ResourceShare;

/// The particles and springs that all sessions have together. To ask and to take is one step, so
/// that what fits once is given once. Safe to use from any thread.
class ResourceBudget {
 public:
  explicit ResourceBudget(const Resources& most) : most_(most) {}

  std::variant<ResourceShare, ResourceExcess> take(const Resources& wanted);
  /// Also beyond the limits: for what was there before the server started.
  ResourceShare take_anyway(const Resources& wanted);
  Resources used() const;

 private:
  friend class ResourceShare;
  std::optional<ResourceExcess> change(const Resources& from, const Resources& to);

  const Resources most_;
  mutable std::mutex mutex_;
  Resources used_;
};

/// A part of the budget, which must outlive it; given back at its end.
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
  /// Changes nothing where it does not fit. Less always fits.
  std::optional<ResourceExcess> resize(const Resources& amount);
  /// Also beyond the limits.
  void resize_anyway(const Resources& amount);

 private:
  friend class ResourceBudget;
  ResourceShare(ResourceBudget& budget, const Resources& amount)
      : budget_(&budget), amount_(amount) {}

  ResourceBudget* budget_;  // null: moved from
  Resources amount_;
};

}  // namespace vat
