#include "core/device/common/kernel_values.h"

#include <algorithm>
#include <vector>

namespace vat {

void write_reals(opencl::Program& program, const opencl::Buffer& buffer,
                 std::span<const double> values) {
  if (program.has_double_pairs()) {
    program.write(buffer, values);
    return;
  }
  std::vector<float> single(values.size());
  std::ranges::transform(values, single.begin(), [](double x) { return static_cast<float>(x); });
  program.write(buffer, std::span<const float>(single));
}

void read_reals(opencl::Program& program, const opencl::Buffer& buffer, std::span<double> values) {
  if (program.has_double_pairs()) {
    program.read(buffer, values);
    return;
  }
  std::vector<float> single(values.size());
  program.read(buffer, std::span<float>(single));
  std::ranges::copy(single, values.begin());
}

}  // namespace vat
