#pragma once

#include <cstddef>

#include "core/types.h"

namespace vat {

/// Predicts how many rounds of sweeps an island of contacts still needs.
class SweepProgress {
 public:
  explicit SweepProgress(Real tolerance) : tolerance_(tolerance) {}

  /// Records the greatest change of a contact in a round of sweeps.
  void add(Real change);
  /// Returns whether the recorded rounds allow a prediction: after 4, 8, 16, ... rounds.
  bool has_prediction() const { return rounds_ == next_; }
  /// Returns the number of rounds until the change is at most the tolerance, if the change
  /// continues to decrease by the factor of the second half of the rounds. Returns infinity if the
  /// change has not decreased. Requires has_prediction().
  Real rounds_left() const;
  /// Returns the number of rounds since the start or since restart().
  std::size_t rounds() const { return rounds_; }
  /// Begins a new series of rounds. Its first prediction needs as many rounds as the next one of
  /// the present series.
  void restart();

 private:
  static constexpr std::size_t kFewRounds = 4;

  Real tolerance_;
  std::size_t rounds_ = 0;
  std::size_t next_ = kFewRounds;  ///< rounds of the next prediction
  Real last_ = 0;                  ///< change of the last round
  Real half_ = 0;                  ///< change at half of the rounds of the next prediction
};

}  // namespace vat
