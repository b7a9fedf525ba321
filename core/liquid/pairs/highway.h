/// Includes the SIMD library Highway, configured for the instruction sets of PairSums. A file that
/// is compiled for all instruction sets must define HWY_TARGET_INCLUDE before including this
/// header.
#ifndef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (HWY_SSE4 | HWY_AVX3_DL)
#endif
#ifndef HWY_BROKEN_EMU128
#define HWY_BROKEN_EMU128 1  // the scalar fallback of all compilers is HWY_SCALAR
#endif
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wold-style-cast"
#pragma GCC diagnostic ignored "-Wshadow"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>
#pragma GCC diagnostic pop
