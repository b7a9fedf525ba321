#include <algorithm>
#include <cstdlib>
#include <limits>

#include "protocol/frame/block_coder.h"
#include "protocol/frame/frame_layout.h"

namespace vat {
namespace {

using frame_layout::has_attribute;
using frame_layout::kMaxAttribute;

constexpr std::uint32_t kFirstClass = residuals::kClasses - 1;
constexpr std::int32_t kMaxResidualSize = 131064;  // [eighths]
constexpr std::int32_t kMiddleOfGrid = 32768;
constexpr std::size_t kMaxStrides = 3;

/// Distances, in the order of particle numbers, to particles that are close in space: neighbours in
/// the lattice from which the body was sampled.
struct Strides {
  std::array<std::uint32_t, kMaxStrides> values{1, 0, 0};
  std::uint32_t count = 1;
};

std::int32_t floor_divided(std::int32_t value, std::int32_t divisor) {
  const std::int32_t quotient = value / divisor;
  return quotient * divisor > value ? quotient - 1 : quotient;
}

std::uint32_t key_class(std::int32_t size) {
  return static_cast<std::uint32_t>(std::clamp(class_of_size(size),
                                               static_cast<std::int32_t>(residuals::kMinKeyClass),
                                               static_cast<std::int32_t>(residuals::kClasses) - 1));
}

/// Returns the sum over the axes of the mean distance at a stride, from about `samples` particles.
double distance_at(const GridBlock& block, const std::vector<std::uint32_t>& places,
                   std::size_t stride, std::size_t samples) {
  const std::size_t step = std::max<std::size_t>(1, (places.size() - stride) / samples);
  std::int64_t sum = 0;
  std::size_t count = 0;
  for (std::size_t i = stride; i < places.size(); i += step, ++count) {
    const std::uint16_t* a = &block.positions[std::size_t{3} * places[i]];
    const std::uint16_t* b = &block.positions[std::size_t{3} * places[i - stride]];
    for (std::size_t q = 0; q < 3; ++q) sum += std::abs(a[q] - b[q]);
  }
  return static_cast<double>(sum) / static_cast<double>(count);
}

/// Returns the stride with the smallest distance, except 1 and strides within 2 of `other`.
std::size_t nearest_stride(const std::vector<double>& distances, std::size_t other) {
  std::size_t best = 0;
  for (std::size_t s = 2; s < distances.size(); ++s) {
    if (s + 2 >= other && s <= other + 2) continue;
    if (best == 0 || distances[s] < distances[best]) best = s;
  }
  return best;
}

/// Returns whether prediction from three strides has smaller residuals than from one, in a sample.
bool three_predict_better(const GridBlock& block, const std::vector<std::uint32_t>& places,
                          const Strides& strides) {
  const std::size_t begin = *std::ranges::max_element(strides.values);
  const std::size_t step = std::max<std::size_t>(1, (places.size() - begin) / 1024);
  std::int64_t by_one = 0;
  std::int64_t by_three = 0;
  for (std::size_t i = begin; i < places.size(); i += step) {
    for (std::size_t q = 0; q < 3; ++q) {
      const auto at = [&](std::size_t back) {
        return std::int64_t{block.positions[std::size_t{3} * places[i - back] + q]};
      };
      by_one += 3 * std::abs(at(0) - at(1));
      by_three += std::abs(3 * at(0) - at(1) - at(strides.values[1]) - at(strides.values[2]));
    }
  }
  return by_three < by_one;
}

/// Returns the distance of each stride from 2 on. A small sample selects the candidates; all other
/// strides have an infinite distance.
std::vector<double> distances_of(const GridBlock& block, const std::vector<std::uint32_t>& places) {
  constexpr std::size_t kMaxStride = 2048;
  constexpr std::size_t kLookedAt = 64;
  constexpr std::size_t kGlance = 24;
  constexpr std::size_t kSamples = 256;
  constexpr double kFar = std::numeric_limits<double>::infinity();
  std::vector<double> distances(std::min(kMaxStride, places.size() / 2), kFar);
  double most = kFar;
  if (distances.size() > kLookedAt + 2) {
    for (std::size_t s = 2; s < distances.size(); ++s) {
      distances[s] = distance_at(block, places, s, kGlance);
    }
    std::vector<double> sorted(distances.begin() + 2, distances.end());
    std::ranges::nth_element(sorted, sorted.begin() + kLookedAt);
    most = sorted[kLookedAt];
  }
  for (std::size_t s = 2; s < distances.size(); ++s) {
    const bool is_near = most == kFar || distances[s] < most;
    distances[s] = is_near ? distance_at(block, places, s, kSamples) : kFar;
  }
  return distances;
}

Strides choose_strides(const GridBlock& block, const std::vector<std::uint32_t>& places) {
  constexpr std::size_t kLeast = 64;
  if (places.size() < kLeast) return {};
  const std::vector<double> distances = distances_of(block, places);
  Strides strides;
  strides.count = 3;
  const std::size_t second = nearest_stride(distances, 0);
  strides.values[1] = static_cast<std::uint32_t>(second);
  strides.values[2] = static_cast<std::uint32_t>(nearest_stride(distances, second));
  return three_predict_better(block, places, strides) ? strides : Strides{};
}

template <class Coder>
void code_strides(Coder& coder, Strides& strides) {
  strides.count = coder.bits(strides.count - 1, 2) + 1;
  if (strides.count > kMaxStrides) return coder.refuse();
  for (std::uint32_t s = 1; s < strides.count; ++s) {
    strides.values[s] = coder.whole(strides.values[s]);
    if (strides.values[s] == 0) return coder.refuse();
  }
}

/// Prediction of three quantities of a particle from preceding particles.
struct Prediction {
  Triple sums{};
  Triple sizes{};
  std::int32_t count = 0;

  void add(const Triple& values, const Triple& value_sizes) {
    ++count;
    for (std::size_t q = 0; q < 3; ++q) {
      sums[q] += 8 * values[q];
      sizes[q] += value_sizes[q];
    }
  }
  Expectation expect(std::size_t q, std::int32_t first_guess, bool share_sizes,
                     std::int32_t& whole) const {
    if (count == 0) {
      whole = first_guess;
      return {kFirstClass, 0};
    }
    const std::int32_t middle = floor_divided(sums[q], count);
    whole = (middle + 4) >> 3;
    const std::int32_t own = sizes[q] / count;
    const std::int32_t all = sizes[0] / count + sizes[1] / count + sizes[2] / count;
    const std::int32_t size = share_sizes ? (13 * own + all) >> 4 : own;
    return {key_class(size << 8), middle - 8 * whole};
  }
};

Triple position_at(const GridBlock& block, std::uint32_t place) {
  const std::uint16_t* position = &block.positions[std::size_t{3} * place];
  return {position[0], position[1], position[2]};
}

template <class Coder>
std::int32_t code_value(Coder& coder, std::int32_t value, std::int32_t whole,
                        const Expectation& expected, std::size_t q, std::int32_t& size) {
  value = whole + coder.residual(value - whole, expected, static_cast<std::uint32_t>(q));
  const std::int64_t off = 8 * (std::int64_t{value} - whole) - expected.fraction;
  size = static_cast<std::int32_t>(std::min<std::int64_t>(std::abs(off), kMaxResidualSize));
  return value;
}

template <class Coder>
void code_places(Coder& coder, const Strides& strides, CodedBlock<Coder>& block,
                 BlockScratch& scratch) {
  const std::vector<std::uint32_t>& places = scratch.added;
  for (std::size_t i = 0; i < places.size(); ++i) {
    Prediction prediction;
    for (std::uint32_t s = 0; s < strides.count; ++s) {
      if (i < strides.values[s]) continue;
      const std::size_t before = i - strides.values[s];
      prediction.add(position_at(block, places[before]), scratch.sizes[before]);
    }
    auto* position = &block.positions[std::size_t{3} * places[i]];
    for (std::size_t q = 0; q < 3; ++q) {
      std::int32_t whole = 0;
      const Expectation expected = prediction.expect(q, kMiddleOfGrid, true, whole);
      const std::int32_t value =
          code_value(coder, position[q], whole, expected, q, scratch.sizes[i][q]);
      if (value < 0 || value > 0xffff) return coder.refuse();
      keep<Coder>(position[q], value);
    }
  }
}

template <class Coder>
void code_column(Coder& coder, const Strides& strides, std::size_t attribute,
                 CodedBlock<Coder>& block, BlockScratch& scratch) {
  const std::vector<std::uint32_t>& places = scratch.added;
  auto& column = block.attributes[attribute];
  for (std::size_t i = 0; i < places.size(); ++i) {
    Prediction prediction;
    for (std::uint32_t s = 0; s < strides.count; ++s) {
      if (i < strides.values[s]) continue;
      const std::size_t before = i - strides.values[s];
      prediction.add({column[places[before]], 0, 0}, {scratch.sizes[before][0], 0, 0});
    }
    std::int32_t whole = 0;
    const Expectation expected = prediction.expect(0, 0, false, whole);
    const std::int32_t value =
        code_value(coder, column[places[i]], whole, expected, attribute % 3, scratch.sizes[i][0]);
    if (std::abs(value) > kMaxAttribute) return coder.refuse();
    keep<Coder>(column[places[i]], value);
  }
}

}  // namespace

template <class Coder>
void code_added(Coder& coder, const FrameScale& scale, CodedBlock<Coder>& block,
                BlockScratch& scratch) {
  if (scratch.added.empty()) return;
  Strides strides;
  if constexpr (!Coder::kReads) strides = choose_strides(block, scratch.added);
  code_strides(coder, strides);
  if (!coder.is_sound()) return;
  scratch.sizes.resize(scratch.added.size());
  code_places(coder, strides, block, scratch);
  for (std::size_t a = 0; a < kFrameAttributes; ++a) {
    if (!coder.is_sound()) return;
    if (has_attribute(block.kind, scale, a)) code_column(coder, strides, a, block, scratch);
  }
}

template void code_added(SymbolWriter&, const FrameScale&, const GridBlock&, BlockScratch&);
template void code_added(SymbolReader&, const FrameScale&, GridBlock&, BlockScratch&);

}  // namespace vat
