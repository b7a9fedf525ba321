/// Includes the SIMD library Highway, configured for the instruction sets of PairSums. Each file
/// that is compiled for all sets includes this header after defining HWY_TARGET_INCLUDE.
#ifndef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (HWY_SSE4 | HWY_AVX3_DL)
#endif
#ifndef HWY_BROKEN_EMU128
#define HWY_BROKEN_EMU128 1  // every compiler builds the scalar loops of HWY_SCALAR
#endif
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wold-style-cast"
#pragma GCC diagnostic ignored "-Wshadow"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>
#pragma GCC diagnostic pop
