/// Highway, with the instruction sets of PairSums: included by each file that is compiled for all
/// of them, after HWY_TARGET_INCLUDE.
#ifndef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (HWY_SSE4 | HWY_AVX3_DL)
#endif
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wold-style-cast"
#pragma GCC diagnostic ignored "-Wshadow"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>
#pragma GCC diagnostic pop
