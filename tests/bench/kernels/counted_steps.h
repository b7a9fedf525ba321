#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "core/support/result.h"
#include "tests/bench/kernels/kernel_counts.h"

namespace vat::bench {

/// A scene whose kernels are counted.
struct CountedKernels {
  std::string name;
  Scene (*make)();
  Real start;  ///< time that the CPU computes before [s]
};

const std::vector<CountedKernels>& counted_kernel_scenes();

/// Work of the kernels in some steps.
struct CountedSteps {
  std::size_t particles = 0;
  std::uint64_t steps = 0;
  std::vector<KernelCounts> kernels;
};

/// Runs the scene on Oclgrind, a simulator of an OpenCL device, and returns the counts. Writes its
/// files to FOLDER. Fails if Oclgrind is missing or fails.
Result<CountedSteps> count_kernels(const CountedKernels& scene,
                                   const std::filesystem::path& folder);

/// The sub-command of this program that runs on Oclgrind.
inline constexpr const char* kCountedKernelsCommand = "run-counted-kernels";

/// Computes the scene until its start on the CPU, and then at least one step on the first device.
/// Writes the numbers of particles and steps to the file. Fails if the device does not take all
/// steps.
Status run_counted_kernels(const CountedKernels& scene, const std::filesystem::path& file);

}  // namespace vat::bench
