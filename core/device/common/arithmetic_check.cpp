#include "core/device/common/arithmetic_check.h"

#include <bit>
#include <cmath>
#include <cstdint>

#include "core/device/common/kernel_values.h"

namespace vat {
namespace {

constexpr std::size_t kCount = 256;
constexpr std::size_t kInputs = 3;
/// The operations in the order of the kernel.
constexpr const char* kOperations[] = {
    "a product and a sum in single precision", "a division in single precision",
    "a square root in single precision",       "a subnormal product",
    "a product and a sum in double precision", "a division in double precision",
    "a square root in double precision"};
constexpr std::size_t kOperationCount = std::size(kOperations);

/// Returns positive numbers of different magnitude, in columns. Their products and sums have about
/// the same magnitude, so that rounding matters.
std::vector<double> inputs() {
  std::vector<double> values(kInputs * kCount);
  std::uint64_t random = 1;
  for (double& value : values) {
    random = random * 6364136223846793005U + 1442695040888963407U;
    const double mantissa = 1 + std::ldexp(static_cast<double>(random >> 12), -52);
    const int exponent = static_cast<int>(random >> 56) % 9 - 4;
    value = std::ldexp(mantissa, exponent);
  }
  return values;
}

}  // namespace

std::vector<double> exact_arithmetic() {
  const std::vector<double> values = inputs();
  std::vector<double> results(kOperationCount * kCount);
  for (std::size_t i = 0; i < kCount; ++i) {
    const double a = values[i];
    const double b = values[kCount + i];
    const double c = values[2 * kCount + i];
    const auto p = static_cast<float>(a);
    const auto q = static_cast<float>(b);
    const auto r = static_cast<float>(c);
    const double exact[kOperationCount] = {static_cast<double>(p * q + r),
                                           static_cast<double>(p / q),
                                           static_cast<double>(std::sqrt(p)),
                                           static_cast<double>(p * 1e-30F * 1e-12F),
                                           a * b + c,
                                           a / b,
                                           std::sqrt(a)};
    for (std::size_t o = 0; o < kOperationCount; ++o) results[o * kCount + i] = exact[o];
  }
  return results;
}

Status check_arithmetic(const opencl::Device& device, std::span<const double> results) {
  const std::vector<double> exact = exact_arithmetic();
  VAT_CHECK(results.size() == exact.size());
  for (std::size_t i = 0; i < exact.size(); ++i) {
    if (std::bit_cast<std::uint64_t>(results[i]) == std::bit_cast<std::uint64_t>(exact[i])) {
      continue;
    }
    return Error{"not_available", "/device",
                 device.name + " (" + device.driver + ") rounds " + kOperations[i / kCount] +
                     " incorrectly; use the arithmetic fast"};
  }
  return {};
}

Status test_arithmetic(opencl::Program& program) {
  const std::vector<double> values = inputs();
  std::vector<double> results(kOperationCount * kCount);
  const opencl::Buffer input(program, values.size() * sizeof(double));
  const opencl::Buffer output(program, results.size() * sizeof(double));
  program.write(input, std::span(values));
  program.run_in_lanes("test_arithmetic", kCount, number_of(kCount), input, output);
  program.read(output, std::span(results));
  return check_arithmetic(program.device(), results);
}

}  // namespace vat
