#include "tests/bench/fanout/segments.h"

#include <algorithm>
#include <limits>
#include <random>
#include <utility>

#include "tests/bench/report/quantile.h"

namespace vat::bench {
namespace {

constexpr int kDraws = 2000;
constexpr double kOutside = 0.025;  // excluded on either side of the interval
constexpr std::size_t kMinSegments = 5;

double drawn_quantile(const Segments& segments, double share, std::mt19937& random) {
  std::uniform_int_distribution<std::size_t> draw(0, segments.size() - 1);
  std::vector<float> values;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const std::vector<float>& segment = segments[draw(random)];
    values.insert(values.end(), segment.begin(), segment.end());
  }
  return static_cast<double>(quantile(std::move(values), share));
}

}  // namespace

double pooled_quantile(const Segments& segments, double share) {
  std::vector<float> values;
  for (const auto& segment : segments) values.insert(values.end(), segment.begin(), segment.end());
  return static_cast<double>(quantile(std::move(values), share));
}

QuantileRatio quantile_ratio(const Segments& a, const Segments& b, double share) {
  QuantileRatio ratio;
  ratio.value = pooled_quantile(b, share) / pooled_quantile(a, share);
  ratio.low = ratio.high = std::numeric_limits<double>::quiet_NaN();
  if (std::min(a.size(), b.size()) < kMinSegments) return ratio;
  std::mt19937 random(1);
  std::vector<float> draws;
  for (int i = 0; i < kDraws; ++i) {
    const double of_a = drawn_quantile(a, share, random);
    draws.push_back(static_cast<float>(drawn_quantile(b, share, random) / of_a));
  }
  ratio.low = static_cast<double>(quantile(draws, kOutside));
  ratio.high = static_cast<double>(quantile(draws, 1 - kOutside));
  return ratio;
}

}  // namespace vat::bench
