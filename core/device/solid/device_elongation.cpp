#include "core/device/solid/device_elongation.h"

#include <cstdint>
#include <span>
#include <vector>

#include "core/device/common/kernel_values.h"
#include "core/device/contact/solid_geometry.h"
#include "core/solid/elongation_limit.h"
#include "core/support/check.h"

namespace vat {
namespace {

using opencl::Program;

/// The struct LimitedSpring of elongation_limit.cl.
struct SpringOnDevice {
  double greatest;
  Index a, b, end, padding;
};

constexpr std::size_t kLimit = 8 * sizeof(double);  // the struct ElongationLimit of its kernels

}  // namespace

DeviceElongation::DeviceElongation(Program& program, const Model& model)
    : program_(program),
      colours_(model.limited_begin.size() - 1),
      begins_(program, model.limited_begin.size() * sizeof(Index)),
      springs_(program, model.limited_springs.size() * sizeof(SpringOnDevice)),
      limits_(program, model.limited_springs.size() * kLimit),
      sweeps_(program, sizeof(std::uint64_t)) {
  VAT_CHECK(colours_ > 0);
  const auto first = static_cast<Index>(SolidRange(model).first);
  std::vector<SpringOnDevice> springs;
  for (const LimitedSpring& spring : model.limited_springs) {
    springs.push_back({spring.greatest, spring.a - first, spring.b - first, spring.end, 0});
  }
  program.write(springs_, std::span<const SpringOnDevice>(springs));
  program.write(begins_,
                std::span<const Index>(model.limited_begin.data(), model.limited_begin.size()));
}

std::size_t DeviceElongation::bytes_for(const Model& model) {
  return model.limited_begin.size() * sizeof(Index) +
         model.limited_springs.size() * (sizeof(SpringOnDevice) + kLimit) + sizeof(std::uint64_t);
}

void DeviceElongation::limit(Real dt, const opencl::Buffer* are_torn,
                             const opencl::Buffer& position, const opencl::Buffer& velocity,
                             const opencl::Buffer& mobility) {
  program_.run("limit_elongation", Program::kGroup, number_of(colours_), dt, kElongationTolerance,
               std::int32_t{kElongationSweeps}, std::int32_t{are_torn != nullptr}, begins_,
               springs_, are_torn != nullptr ? *are_torn : begins_, position, mobility, velocity,
               limits_, sweeps_);
}

void DeviceElongation::clear_counts() {
  program_.fill_with_zeros(sweeps_, sizeof(std::uint64_t));
}

void DeviceElongation::count(AdvanceReport& report) {
  std::uint64_t sweeps = 0;
  program_.read(sweeps_, std::span(&sweeps, 1));
  report.iterations.elongation += sweeps;
}

}  // namespace vat
