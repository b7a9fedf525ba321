#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "core/stage/advance_report.h"

/// Iterations of the solves of a step against the size of the problem.
namespace vat::stability {

/// A family of scenes that differ in one size.
struct GrowthFamily {
  const char* name;
  const char* size;  ///< name of the size
  std::vector<int> sizes;
  Scene (*make)(int size);
  std::uint64_t IterationCounts::*iterations;
};

/// Stacks of blocks and walls of bricks with projected contacts, a viscous pool, ropes of implicit
/// springs, and ropes with limited elongation.
const std::vector<GrowthFamily>& growth_families();

struct GrowthPoint {
  int size = 0;
  double iterations = 0;  ///< per step
  double seconds = 0;     ///< wall time of a step
  std::uint64_t particles = 0;
  std::uint64_t events = 0;  ///< guard events
};

/// Advances the scene of `size` by `steps` steps, and measures the following `steps`.
GrowthPoint measure_growth(const GrowthFamily& family, int size, Index steps);

}  // namespace vat::stability
