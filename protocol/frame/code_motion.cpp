#include <algorithm>
#include <cmath>

#include "protocol/frame/block_coder.h"
#include "protocol/frame/frame_layout.h"

namespace vat {
namespace {

using frame_layout::kMaxAttribute;

constexpr std::uint32_t kShiftBits = 3;
constexpr std::int32_t kShiftOffset = 4;

/// A least-squares fit of the factors in y ~ a * u + b * v.
struct Fit {
  double uu = 1e-9, uv = 0, vv = 1e-9, uy = 0, vy = 0;

  void add(double u, double v, double y) {
    uu += u * u;
    uv += u * v;
    vv += v * v;
    uy += u * y;
    vy += v * y;
  }
  static std::int32_t factor(double value) {
    if (!std::isfinite(value)) return 0;
    return static_cast<std::int32_t>(
        std::clamp(std::round(256 * value), -double{kFactorOffset}, kFactorOffset - 1.0));
  }
  std::int32_t a() const { return factor((uy * vv - vy * uv) / (uu * vv - uv * uv)); }
  std::int32_t b() const { return factor((vy * uu - uy * uv) / (uu * vv - uv * uv)); }
  std::int32_t b_alone() const { return factor(vy / vv); }
};

/// Replaces a writer: stores the residuals, chooses the tuning with the lowest cost, and writes
/// them.
class TuningChoice {
 public:
  static constexpr bool kReads = false;
  /// A tuning that keeps all classes in range. Residuals without context have a separate class.
  static constexpr Neighbourhood::Tuning kNeutral{3, residuals::kClasses};

  explicit TuningChoice(std::vector<BlockScratch::CodedResidual>& lefts) : lefts_(lefts) {
    lefts.clear();
  }

  std::int32_t residual(std::int32_t value, const Expectation& expected, std::uint32_t lane) {
    lefts_.push_back({value, static_cast<std::uint8_t>(expected.residual_class),
                      static_cast<std::int8_t>(expected.fraction),
                      static_cast<std::uint8_t>(lane)});
    const std::int32_t bin = std::min(std::abs(value), kBins - 1);
    Counts& counts = counts_[expected.residual_class];
    ++counts.bins[static_cast<std::size_t>(bin)];
    counts.end = std::max(counts.end, bin + 1);
    return value;
  }
  void refuse() {}

  void write(const Neighbourhood::Tuning& tuning, SymbolWriter& writer) const {
    for (const BlockScratch::CodedResidual& left : lefts_) {
      const std::uint32_t index = left.residual_class == residuals::kClasses
                                      ? tuning.first_class
                                      : shifted(left.residual_class, tuning.shift);
      writer.residual(left.value, {index, left.fraction}, left.lane);
    }
  }

  Neighbourhood::Tuning best() const {
    Neighbourhood::Tuning best;
    best.shift = static_cast<std::int32_t>(cheapest(
                     2 * kShiftOffset,
                     [&](std::uint32_t coded) {
                       return cost_of_shift(static_cast<std::int32_t>(coded) - kShiftOffset);
                     })) -
                 kShiftOffset;
    best.first_class = cheapest(residuals::kClasses, [&](std::uint32_t c) {
      return cost_of(counts_[residuals::kClasses], c);
    });
    return best;
  }

 private:
  static constexpr std::int32_t kBins = 64;
  /// A histogram of magnitudes. All bins from `end` on are 0.
  struct Counts {
    std::array<std::uint32_t, kBins> bins{};
    std::int32_t end = 0;
  };

  template <class Cost>
  static std::uint32_t cheapest(std::uint32_t count, Cost cost) {
    std::uint32_t best = 0;
    double least = cost(0);
    for (std::uint32_t i = 1; i < count; ++i) {
      const double here = cost(i);
      if (here >= least) continue;
      best = i;
      least = here;
    }
    return best;
  }
  static double cost_of(const Counts& counts, std::uint32_t residual_class) {
    double cost = 0;
    for (std::int32_t bin = 0; bin < counts.end; ++bin) {
      const std::uint32_t count = counts.bins[static_cast<std::size_t>(bin)];
      if (count > 0) cost += count * static_cast<double>(residual_cost(residual_class, bin));
    }
    return cost;
  }
  static std::uint32_t shifted(std::uint32_t residual_class, std::int32_t shift) {
    constexpr auto kLast = static_cast<std::int32_t>(residuals::kClasses) - 1;
    const std::int32_t index = static_cast<std::int32_t>(residual_class) - kNeutral.shift + shift;
    return static_cast<std::uint32_t>(std::clamp(index, 0, kLast));
  }
  double cost_of_shift(std::int32_t shift) const {
    double cost = 0;
    for (std::uint32_t c = 0; c < residuals::kClasses; ++c) {
      cost += cost_of(counts_[c], shifted(c, shift));
    }
    return cost;
  }

  std::vector<BlockScratch::CodedResidual>& lefts_;
  std::array<Counts, residuals::kClasses + 1> counts_{};
};

template <class Coder>
void code_tuning(Coder& coder, Neighbourhood::Tuning& tuning) {
  tuning.shift = static_cast<std::int32_t>(coder.bits(
                     static_cast<std::uint32_t>(tuning.shift + kShiftOffset), kShiftBits)) -
                 kShiftOffset;
  tuning.first_class = coder.bits(tuning.first_class, kClassBits);
  if (tuning.first_class >= residuals::kClasses) coder.refuse();
}

/// Codes three quantities of all remaining particles, cell by cell. `predict(i, cell)` returns the
/// prediction [eighths] for particle i of the first reference, and `value(place)` the values of the
/// frame's particle. `store(place, values)` stores decoded values; false refuses them. Ignores
/// quantities that are not `coded`.
template <class Coder, class Predict, class Value, class Store>
void code_cells(Coder& coder, BlockScratch& scratch, const std::array<bool, 3>& coded,
                const Neighbourhood::Tuning& tuning, Predict predict, Value value, Store store) {
  Neighbourhood& neighbours = scratch.neighbours;
  const auto cells = scratch.cells.cells();
  const auto order = scratch.cells.order();
  neighbours.start(cells.size(), tuning);
  for (std::size_t c = 1; c < cells.size(); ++c) {
    neighbours.enter(cells[c]);
    for (std::uint32_t k = cells[c].begin; k < cells[c].end; ++k) {
      const std::uint32_t i = order[k];
      const std::uint32_t place = scratch.new_place[i];
      if (place == BlockScratch::kNone) continue;
      const Triple predictions = predict(i, c);
      Triple wholes;
      std::array<Expectation, 3> expected;
      neighbours.expect(predictions, wholes, expected);
      Triple values = wholes;
      if constexpr (!Coder::kReads) values = value(place);
      for (std::uint32_t q = 0; q < 3; ++q) {
        if (!coded[q]) continue;
        values[q] = wholes[q] + coder.residual(values[q] - wholes[q], expected[q], q);
      }
      if (!store(place, values)) return coder.refuse();
      neighbours.learn(predictions, wholes, expected, values);
    }
    neighbours.leave(c);
  }
}

/// Computes the mean step from the second reference to the first, over a cell and its neighbours.
void find_mean_steps(const GridBlock& first, const GridBlock* second, BlockScratch& scratch) {
  constexpr std::int32_t kMaxParticleStep = 8191;
  constexpr std::uint32_t kMaxCounted = 63;
  const auto cells = scratch.cells.cells();
  const auto order = scratch.cells.order();
  scratch.mean_step.assign(cells.size(), {});
  if (second == nullptr) return;
  scratch.step_sums.assign(cells.size(), {});
  for (std::size_t c = 1; c < cells.size(); ++c) {
    auto& [x, y, z, count] = scratch.step_sums[c];
    const std::uint32_t end = std::min(cells[c].end, cells[c].begin + kMaxCounted);
    for (std::uint32_t k = cells[c].begin; k < end; ++k) {
      const std::uint32_t i = order[k];
      const std::uint32_t j = scratch.second_place[i];
      if (j == BlockScratch::kNone) continue;
      const std::uint16_t* a = &first.positions[std::size_t{3} * i];
      const std::uint16_t* b = &second->positions[std::size_t{3} * j];
      x += std::clamp(a[0] - b[0], -kMaxParticleStep, kMaxParticleStep);
      y += std::clamp(a[1] - b[1], -kMaxParticleStep, kMaxParticleStep);
      z += std::clamp(a[2] - b[2], -kMaxParticleStep, kMaxParticleStep);
      ++count;
    }
  }
  for (std::size_t c = 1; c < cells.size(); ++c) {
    std::array<std::int32_t, 4> sum{};
    const std::uint32_t row = scratch.cells.row();
    for (const std::uint32_t layer : {0U, scratch.cells.layer(), 2 * scratch.cells.layer()}) {
      for (const std::uint32_t line : {0U, row, 2 * row}) {
        const std::uint32_t corner = cells[c].place - scratch.cells.layer() - row - 1;
        for (std::uint32_t column = 0; column < 3; ++column) {
          const std::uint32_t near = scratch.cells.cell_at(corner + layer + line + column);
          for (std::size_t q = 0; q < 4; ++q) sum[q] += scratch.step_sums[near][q];
        }
      }
    }
    const std::int32_t inverse = kInverse[static_cast<std::size_t>(sum[3])];
    for (std::size_t q = 0; q < 3; ++q) scratch.mean_step[c][q] = sum[q] * inverse >> 13;
  }
}

/// Predicts positions from the neighbours' mean step and from the particle's deviation from it.
struct MotionPrediction {
  const GridBlock& first;
  const GridBlock* second;
  const BlockScratch& scratch;
  std::int32_t common = 0;  ///< factor of the mean step
  std::int32_t own = 0;     ///< factor of the particle's deviation from the mean step

  Triple excess(std::uint32_t i, std::size_t cell) const {
    const std::uint32_t j = second != nullptr ? scratch.second_place[i] : BlockScratch::kNone;
    if (j == BlockScratch::kNone) return {};
    Triple result;
    for (std::size_t q = 0; q < 3; ++q) {
      const std::int32_t step = first.positions[std::size_t{3} * i + q] -
                                std::int32_t{second->positions[std::size_t{3} * j + q]};
      result[q] = 8 * step - scratch.mean_step[cell][q];
    }
    return result;
  }
  Triple operator()(std::uint32_t i, std::size_t cell) const {
    const Triple beyond = excess(i, cell);
    const Triple& mean = scratch.mean_step[cell];
    Triple result;
    for (std::size_t q = 0; q < 3; ++q) {
      result[q] = 8 * first.positions[std::size_t{3} * i + q] +
                  ((common * mean[q] + own * beyond[q] + 128) >> 8);
    }
    return result;
  }
};

void fit_factors(const GridBlock& block, MotionPrediction& prediction) {
  Fit fit;
  const BlockScratch& scratch = prediction.scratch;
  const auto cells = scratch.cells.cells();
  const std::uint32_t step = scratch.cells.order().size() > 4096 ? 4 : 1;
  for (std::size_t c = 1; c < cells.size(); ++c) {
    for (std::uint32_t k = cells[c].begin; k < cells[c].end; k += step) {
      const std::uint32_t i = scratch.cells.order()[k];
      const std::uint32_t place = scratch.new_place[i];
      if (place == BlockScratch::kNone) continue;
      const Triple beyond = prediction.excess(i, c);
      for (std::size_t q = 0; q < 3; ++q) {
        const std::int32_t moved = block.positions[std::size_t{3} * place + q] -
                                   prediction.first.positions[std::size_t{3} * i + q];
        fit.add(scratch.mean_step[c][q], beyond[q], 8 * moved);
      }
    }
  }
  prediction.common = fit.a();
  prediction.own = fit.b();
}

/// Extrapolates the change of an attribute.
struct AttributePrediction {
  const GridBlock& first;
  const GridBlock* second;
  const BlockScratch& scratch;
  std::size_t begin;          ///< quantity q is the attribute begin + q
  std::array<bool, 3> moved;  ///< by quantity; false beyond the last attribute
  Triple factors{};

  std::int32_t value(const GridBlock& block, std::uint32_t i, std::size_t q) const {
    return block.attributes[begin + q][i];
  }
  std::int32_t step(std::uint32_t i, std::size_t q) const {
    const std::uint32_t j = second != nullptr ? scratch.second_place[i] : BlockScratch::kNone;
    return j == BlockScratch::kNone ? 0 : value(first, i, q) - value(*second, j, q);
  }
  Triple operator()(std::uint32_t i, std::size_t) const {
    Triple result{};
    for (std::size_t q = 0; q < 3; ++q) {
      if (!moved[q]) continue;
      const std::int64_t change = (std::int64_t{8} * factors[q] * step(i, q) + 128) >> 8;
      result[q] = static_cast<std::int32_t>(8 * value(first, i, q) + change);
    }
    return result;
  }
};

void fit_factors(const GridBlock& block, AttributePrediction& prediction) {
  for (std::size_t q = 0; q < 3; ++q) {
    if (!prediction.moved[q]) continue;
    Fit fit;
    for (std::uint32_t i = 0; i < prediction.first.particle_count(); ++i) {
      const std::uint32_t place = prediction.scratch.new_place[i];
      if (place == BlockScratch::kNone) continue;
      fit.add(0, prediction.step(i, q),
              prediction.value(block, place, q) - prediction.value(prediction.first, i, q));
    }
    prediction.factors[q] = fit.b_alone();
  }
}

constexpr std::array<bool, 3> kAll{true, true, true};
constexpr auto kNothing = [](std::uint32_t, const Triple&) { return true; };

}  // namespace

template <class Coder>
void code_positions(Coder& coder, const GridBlock& first, const GridBlock* second,
                    CodedBlock<Coder>& block, BlockScratch& scratch) {
  find_mean_steps(first, second, scratch);
  MotionPrediction prediction{first, second, scratch};
  const auto value = [&](std::uint32_t place) {
    const std::uint16_t* position = &block.positions[std::size_t{3} * place];
    return Triple{position[0], position[1], position[2]};
  };
  const auto code_header = [&](Neighbourhood::Tuning tuning) {
    prediction.common = code_factor(coder, prediction.common);
    prediction.own = code_factor(coder, prediction.own);
    code_tuning(coder, tuning);
    return tuning;
  };
  if constexpr (Coder::kReads) {
    const Neighbourhood::Tuning tuning = code_header({});
    if (!coder.is_sound()) return;
    const auto store = [&](std::uint32_t place, const Triple& values) {
      if (((values[0] | values[1] | values[2]) & ~0xffff) != 0) return false;
      std::uint16_t* position = &block.positions[std::size_t{3} * place];
      for (std::size_t q = 0; q < 3; ++q) position[q] = static_cast<std::uint16_t>(values[q]);
      return true;
    };
    code_cells(coder, scratch, kAll, tuning, prediction, value, store);
  } else {
    fit_factors(block, prediction);
    TuningChoice choice(scratch.lefts);
    code_cells(choice, scratch, kAll, TuningChoice::kNeutral, prediction, value, kNothing);
    choice.write(code_header(choice.best()), coder);
  }
}

template <class Coder>
void code_attributes(Coder& coder, const GridBlock& first, const GridBlock* second,
                     std::size_t begin, const ByAttribute<bool>& changes, CodedBlock<Coder>& block,
                     BlockScratch& scratch) {
  std::array<bool, 3> moved{};
  for (std::size_t q = 0; q < 3 && begin + q < kFrameAttributes; ++q) moved[q] = changes[begin + q];
  if (moved == std::array<bool, 3>{}) return;
  AttributePrediction prediction{first, second, scratch, begin, moved};
  const auto value = [&](std::uint32_t place) {
    Triple values{};
    for (std::size_t q = 0; q < 3; ++q) {
      if (moved[q]) values[q] = prediction.value(block, place, q);
    }
    return values;
  };
  const auto code_header = [&](Neighbourhood::Tuning tuning) {
    for (std::size_t q = 0; q < 3; ++q) {
      if (moved[q]) prediction.factors[q] = code_factor(coder, prediction.factors[q]);
    }
    code_tuning(coder, tuning);
    return tuning;
  };
  if constexpr (Coder::kReads) {
    const Neighbourhood::Tuning tuning = code_header({});
    if (!coder.is_sound()) return;
    const auto store = [&](std::uint32_t place, const Triple& values) {
      for (std::size_t q = 0; q < 3; ++q) {
        if (!moved[q]) continue;
        if (std::abs(values[q]) > kMaxAttribute) return false;
        block.attributes[begin + q][place] = values[q];
      }
      return true;
    };
    code_cells(coder, scratch, moved, tuning, prediction, value, store);
  } else {
    fit_factors(block, prediction);
    TuningChoice choice(scratch.lefts);
    code_cells(choice, scratch, moved, TuningChoice::kNeutral, prediction, value, kNothing);
    choice.write(code_header(choice.best()), coder);
  }
}

template void code_positions(SymbolWriter&, const GridBlock&, const GridBlock*, const GridBlock&,
                             BlockScratch&);
template void code_positions(SymbolReader&, const GridBlock&, const GridBlock*, GridBlock&,
                             BlockScratch&);
template void code_attributes(SymbolWriter&, const GridBlock&, const GridBlock*, std::size_t,
                              const ByAttribute<bool>&, const GridBlock&, BlockScratch&);
template void code_attributes(SymbolReader&, const GridBlock&, const GridBlock*, std::size_t,
                              const ByAttribute<bool>&, GridBlock&, BlockScratch&);

}  // namespace vat
