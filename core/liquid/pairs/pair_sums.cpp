#include "core/liquid/pairs/pair_sums.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/support/check.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/liquid/pairs/pair_sums.cpp"  // NOLINT
#include "core/liquid/pairs/highway.h"
// Included once for each instruction set, by the line above:
#include "core/liquid/pairs/pair_loops-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vat::HWY_NAMESPACE {

const PairSums& sums_of(PairPrecision precision, KernelId kernel) {
  return precision == PairPrecision::single_precision ? Loops<float>::table(kernel)
                                                      : Loops<double>::table(kernel);
}

}  // namespace vat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vat {
PositionGrid::PositionGrid(const Vec3& corner, Real span)
    : origin(corner),
      unit(std::exp2(std::ceil(std::log2(span / kCount)))),
      inverse_unit(1 / unit) {}

const PairSums& pair_sums(InstructionSet set, PairPrecision precision, KernelId kernel) {
#if HWY_ARCH_X86
  if (set == InstructionSet::avx512) return N_AVX3::sums_of(precision, kernel);
  if (set == InstructionSet::avx2) return N_AVX2::sums_of(precision, kernel);
  // Older processors compute the same bits with scalar instructions.
  if (__builtin_cpu_supports("ssse3")) return N_SSSE3::sums_of(precision, kernel);
#endif
  return pair_sums_without_vectors(precision, kernel);
}

const PairSums& pair_sums_without_vectors(PairPrecision precision, KernelId kernel) {
  return N_SCALAR::sums_of(precision, kernel);
}

CullFunction cull_function(InstructionSet set) {
#if HWY_ARCH_X86
  if (set == InstructionSet::avx512) return &N_AVX3::cull;
  if (set == InstructionSet::avx2) return &N_AVX2::cull;
  if (__builtin_cpu_supports("ssse3")) return &N_SSSE3::cull;
#endif
  return &N_SCALAR::cull;
}

std::size_t lane_count(InstructionSet set) {
  switch (set) {
    case InstructionSet::avx512:
      return 16;
    case InstructionSet::avx2:
      return 8;
    case InstructionSet::baseline:
      break;
  }
  return 4;
}

}  // namespace vat
#endif
