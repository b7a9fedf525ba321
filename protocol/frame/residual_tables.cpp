#include "protocol/frame/residual_tables.h"

#include <algorithm>

namespace vat::residuals {
namespace {

// 65536 / (1 + exp(-k / 8)).
constexpr std::array<std::int32_t, 82> kLogistic{
    32768, 34813, 36843, 38841, 40793, 42687, 44511, 46254, 47911, 49474, 50941, 52310,
    53581, 54754, 55834, 56822, 57724, 58544, 59287, 59959, 60565, 61109, 61598, 62036,
    62428, 62778, 63090, 63368, 63615, 63835, 64030, 64203, 64357, 64494, 64614, 64721,
    64816, 64900, 64974, 65039, 65097, 65149, 65194, 65234, 65269, 65300, 65328, 65352,
    65374, 65393, 65410, 65425, 65438, 65449, 65459, 65468, 65476, 65483, 65489, 65495,
    65500, 65504, 65508, 65511, 65514, 65517, 65519, 65521, 65523, 65524, 65526, 65527,
    65528, 65529, 65530, 65530, 65531, 65532, 65532, 65533, 65533, 65533};
// 256 / s for the scales s = 0.045 * 2^(t / 4), and the radius of the coded residuals, 7 s + 1.
constexpr std::array<std::int32_t, kTables> kSteepness{
    5689, 4784, 4023, 3383, 2844, 2392, 2011, 1691, 1422, 1196, 1006, 846,
    711,  598,  503,  423,  356,  299,  251,  211,  178,  149,  126,  106};
constexpr std::array<int, kTables> kRadius{2, 2, 2, 2, 2, 2, 2, 3,  3,  3,  3,  4,
                                           4, 4, 5, 6, 7, 7, 9, 10, 12, 13, 16, 18};
constexpr std::array<std::int32_t, kPlaces> kMiddle{1, 3};  // [eighths]

/// Returns the cumulative distribution, of 65536, at `eighths` of a distribution centred at zero.
std::int32_t part_below(std::int32_t eighths, std::int32_t steepness) {
  const std::int32_t steps = (eighths < 0 ? -eighths : eighths) * steepness;
  const auto index = static_cast<std::size_t>(std::min(steps >> 8, 80));
  const std::int32_t rest = (kLogistic[index + 1] - kLogistic[index]) * (steps & 255) >> 8;
  const std::int32_t part = kLogistic[index] + rest;
  return eighths < 0 ? 65536 - part : part;
}

void fill_table(std::size_t table, std::size_t place, std::size_t index, Tables& all) {
  const int radius = kRadius[table];
  const int symbols = 2 * radius + 2;
  const auto below = [&](int residual) {
    return part_below(8 * residual - 4 - kMiddle[place], kSteepness[table]);
  };
  // Every symbol has a frequency of 1, plus its share of the remaining 4096.
  const auto start = [&](int k) {
    if (k == symbols) return static_cast<std::int32_t>(rans::kScale);
    const auto spare = static_cast<std::int32_t>(rans::kScale) - symbols;
    return k + ((below(k - radius) - below(-radius)) * spare >> 16);
  };
  all.radius[index] = radius;
  for (int k = 0; k < symbols; ++k) {
    const auto begin = static_cast<std::uint32_t>(start(k));
    const auto end = static_cast<std::uint32_t>(start(k + 1));
    all.range[index][static_cast<std::size_t>(k)] = begin | (end - begin) << 16;
    for (std::uint32_t slot = begin; slot < end; ++slot) {
      all.symbol[index][slot] = static_cast<std::uint8_t>(k);
    }
  }
}

Tables make_tables() noexcept {
  Tables all;
  for (std::uint32_t table = 0; table < kTables; ++table) {
    for (std::uint32_t place = 0; place < kPlaces; ++place) {
      fill_table(table, place, Tables::index(table, place == 1), all);
    }
  }
  return all;
}

}  // namespace

const Tables kAllTables = make_tables();

}  // namespace vat::residuals
