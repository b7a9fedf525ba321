#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/support/result.h"
#include "core/types.h"
#include "tests/bench/report/csv_file.h"

namespace vat::bench {

/// The mean work of a kernel.
struct KernelCounts {
  std::string name;
  Real runs = 0;  ///< per step
  // Of one run, per particle of the scene:
  Real single_operations = 0;  ///< sums, products, divisions and square roots in single precision
  Real double_operations = 0;  ///< the same in double precision
  Real instructions = 0;       ///< all instructions, in the form of LLVM
  Real accessed_bytes = 0;     ///< that work-items load and store
  Real group_bytes = 0;        ///< of the sectors of 32 bytes that a work-group accesses
  Real distinct_bytes = 0;     ///< of the sectors of 32 bytes that the run accesses
};

/// Reads a file of the plugin in counter/. Fails if a column or number is missing.
Result<std::vector<KernelCounts>> read_kernel_counts(const CsvFile& file, std::uint64_t steps,
                                                     std::size_t particles);

/// A GPU as in the publications of its manufacturer.
struct Gpu {
  const char* name;
  Real instruction_rate;  ///< lanes of single precision times clock [1/s]
  Real double_rate;       ///< lanes of double precision times clock [1/s]
  Real bandwidth;         ///< of the main memory [bytes/s]
};

/// H200 and H100 (SXM5), and RTX 4060.
const std::vector<Gpu>& known_gpus();

/// Returns the predicted time [s] of one run of a kernel with many `particles`. The slowest of the
/// units bounds it: instructions, operations in double precision, or main memory. Starting a kernel
/// takes 4 microseconds.
Real predict_run(const KernelCounts& kernel, const Gpu& gpu, Real particles);
/// Returns the predicted time [s] of a step.
Real predict_step(const std::vector<KernelCounts>& kernels, const Gpu& gpu, Real particles);

}  // namespace vat::bench
