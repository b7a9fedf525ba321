#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "protocol/frame/cell_order.h"
#include "protocol/frame/symbols.h"

/// Prediction of particle data from neighbouring particles (FRAMES.md, "Context of neighbouring
/// cells"). All numbers are integers, so that all decoders compute the same values.
namespace vat {

using Triple = std::array<std::int32_t, 3>;

inline constexpr std::size_t kInverses = 2048;
/// Table of 65536 / n, rounded down.
inline constexpr std::array<std::int32_t, kInverses> kInverse = [] {
  std::array<std::int32_t, kInverses> all{};
  for (std::size_t n = 1; n < kInverses; ++n) all[n] = 65536 / static_cast<std::int32_t>(n);
  return all;
}();

/// Returns the residual class for a mean residual magnitude of `size` / 2048.
inline std::int32_t class_of_size(std::int32_t size) {
  const auto s = static_cast<std::uint32_t>(std::max(size, 64));
  const int octave = static_cast<int>(std::bit_width(s)) - 7;
  return 4 * octave + static_cast<int>(s >> (octave + 4) & 3) - 3;
}

/// Context for the coding of three quantities per particle, cell by cell. The residuals of earlier
/// particles correct the next prediction and determine the width of the residual's distribution.
class Neighbourhood {
 public:
  /// Parameters chosen by the encoder. `shift` is added to all classes. `first_class` is used
  /// without context.
  struct Tuning {
    std::int32_t shift = 0;
    std::uint32_t first_class = 0;
  };

  void start(std::size_t cells, const Tuning& tuning) {
    cells_.assign(cells, {});
    tuning_ = tuning;
  }
  void enter(const CellOrder::Cell& cell) {
    before_ = own_ = {};
    for (const std::uint32_t number : cell.before) before_.add(cells_[number]);
  }
  void leave(std::size_t cell) { cells_[cell] = own_; }

  /// Writes the integer parts of the corrected predictions and the residual distributions.
  /// `predictions` are in eighths.
  void expect(const Triple& predictions, Triple& wholes,
              std::array<Expectation, 3>& expected) const;
  void learn(const Triple& predictions, const Triple& wholes,
             const std::array<Expectation, 3>& expected, const Triple& values);

 private:
  static constexpr std::int32_t kMaxCounted = 63;         // particles per cell
  static constexpr std::int32_t kMaxResidual = 8184;      // in eighths
  static constexpr std::int32_t kMaxResidualSize = 2047;  // in eighths

  struct Sums {
    std::int32_t count = 0;
    Triple residual{};
    Triple size{};

    void add(const Sums& other) {
      count += other.count;
      for (std::size_t q = 0; q < 3; ++q) {
        residual[q] += other.residual[q];
        size[q] += other.size[q];
      }
    }
  };

  std::vector<Sums> cells_;
  Tuning tuning_;
  Sums before_;  // sums of the three preceding neighbour cells
  Sums own_;
};

inline void Neighbourhood::expect(const Triple& predictions, Triple& wholes,
                                  std::array<Expectation, 3>& expected) const {
  constexpr std::int32_t kMaxClass = static_cast<std::int32_t>(residuals::kClasses) - 1;
  const bool is_first = own_.count + before_.count == 0;
  const std::int32_t weight = 4 * own_.count + before_.count + 1;
  const std::int32_t inverse = kInverse[static_cast<std::size_t>(weight)];
  Triple size;
  for (std::size_t q = 0; q < 3; ++q) size[q] = 4 * own_.size[q] + before_.size[q] + 8;
  const std::int32_t all = size[0] + size[1] + size[2];
  for (std::size_t q = 0; q < 3; ++q) {
    const std::int32_t residual = 4 * own_.residual[q] + before_.residual[q];
    const std::int32_t middle = predictions[q] + (residual * inverse >> 16);
    wholes[q] = (middle + 4) >> 3;
    expected[q].fraction = middle - 8 * wholes[q];
    const std::int32_t mean = ((13 * size[q] + all) >> 4) * inverse >> 8;
    const std::int32_t index = std::clamp(class_of_size(mean) + tuning_.shift, 0, kMaxClass);
    expected[q].residual_class = is_first ? tuning_.first_class : static_cast<std::uint32_t>(index);
  }
}

inline void Neighbourhood::learn(const Triple& predictions, const Triple& wholes,
                                 const std::array<Expectation, 3>& expected, const Triple& values) {
  if (own_.count == kMaxCounted) return;
  ++own_.count;
  for (std::size_t q = 0; q < 3; ++q) {
    const std::int32_t residual = 8 * values[q] - predictions[q];
    const std::int32_t off = 8 * (values[q] - wholes[q]) - expected[q].fraction;
    own_.residual[q] += std::clamp(residual, -kMaxResidual, kMaxResidual);
    own_.size[q] += std::min(std::abs(off), kMaxResidualSize);
  }
}

}  // namespace vat
