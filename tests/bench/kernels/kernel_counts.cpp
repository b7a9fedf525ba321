#include "tests/bench/kernels/kernel_counts.h"

#include <algorithm>
#include <charconv>
#include <string_view>
#include <system_error>

namespace vat::bench {

namespace {

constexpr Real kStart = 4e-6;  // of a kernel [s]

/// Returns the number in a cell, or fails.
Result<Real> number_at(const CsvFile& file, std::size_t row, std::string_view column) {
  const auto found = std::ranges::find(file.columns, column);
  if (found == file.columns.end()) {
    return Error{"missing", "", "has no column '" + std::string(column) + "'"};
  }
  const std::string& cell = file.rows[row][static_cast<std::size_t>(found - file.columns.begin())];
  std::uint64_t value = 0;
  const char* end = cell.data() + cell.size();
  const auto [rest, error] = std::from_chars(cell.data(), end, value);
  if (error == std::errc{} && rest == end) return static_cast<Real>(value);
  return Error{"malformed", "",
               "row " + std::to_string(row + 2) + ": '" + std::string(column) +
                   "' must be a whole number, and is '" + cell + "'"};
}

}  // namespace

Result<std::vector<KernelCounts>> read_kernel_counts(const CsvFile& file, std::uint64_t steps,
                                                     std::size_t particles) {
  std::vector<KernelCounts> kernels;
  for (std::size_t row = 0; row < file.rows.size(); ++row) {
    KernelCounts kernel;
    kernel.name = file.rows[row].front();
    const Result<Real> runs = number_at(file, row, "runs");
    if (!runs) return runs.errors();
    if (runs.value() == 0) return Error{"malformed", "", kernel.name + " has no runs"};
    kernel.runs = runs.value() / static_cast<Real>(steps);
    const std::pair<std::string_view, Real*> means[] = {
        {"single", &kernel.single_operations},  {"double", &kernel.double_operations},
        {"instructions", &kernel.instructions}, {"accessed", &kernel.accessed_bytes},
        {"of_groups", &kernel.group_bytes},     {"distinct", &kernel.distinct_bytes}};
    for (const auto& [column, mean] : means) {
      const Result<Real> sum = number_at(file, row, column);
      if (!sum) return sum.errors();
      *mean = sum.value() / (runs.value() * static_cast<Real>(particles));
    }
    kernels.push_back(kernel);
  }
  if (kernels.empty()) return Error{"missing", "", "has no kernels"};
  return kernels;
}

const std::vector<Gpu>& known_gpus() {
  // Units of single and double precision, times the boost clock; see core/device/DEVICE.md.
  static const std::vector<Gpu> kGpus = {
      {"H200", 132 * 128 * 1.98e9, 132 * 64 * 1.98e9, 4.8e12},
      {"H100", 132 * 128 * 1.98e9, 132 * 64 * 1.98e9, 3.35e12},
      {"RTX 4060", 24 * 128 * 2.46e9, 24 * 2 * 2.46e9, 0.272e12},
  };
  return kGpus;
}

Real predict_run(const KernelCounts& kernel, const Gpu& gpu, Real particles) {
  return kStart + particles * std::max({kernel.instructions / gpu.instruction_rate,
                                        kernel.double_operations / gpu.double_rate,
                                        kernel.distinct_bytes / gpu.bandwidth});
}

Real predict_step(const std::vector<KernelCounts>& kernels, const Gpu& gpu, Real particles) {
  Real sum = 0;
  for (const KernelCounts& kernel : kernels) {
    sum += kernel.runs * predict_run(kernel, gpu, particles);
  }
  return sum;
}

}  // namespace vat::bench
