#include "core/device/common/device_cells.h"

namespace vat {
namespace {

using opencl::Program;

constexpr std::size_t kScanBlock = 1024;  // SCAN_BLOCK of cells.cl
constexpr std::size_t kCellNumber = sizeof(std::int32_t);

std::size_t scan_blocks(std::size_t cells) {
  return (cells + kScanBlock - 1) / kScanBlock;
}

}  // namespace

DevicePrefixSums::DevicePrefixSums(Program& program, std::size_t count)
    : program_(program), count_(count), block_sums_(program, scan_blocks(count) * kCellNumber) {}

std::size_t DevicePrefixSums::bytes_for(std::size_t count) {
  return scan_blocks(count) * kCellNumber;
}

void DevicePrefixSums::sum(const opencl::Buffer& values, const opencl::Buffer& begins) {
  const auto count = static_cast<std::int32_t>(count_);
  const std::size_t blocks = scan_blocks(count_);
  const std::size_t scanners = blocks * Program::kGroup;
  program_.run("sum_blocks", scanners, count, values, block_sums_);
  program_.run("scan_sums", Program::kGroup, static_cast<std::int32_t>(blocks), block_sums_);
  program_.run("scan_blocks", scanners, count, values, block_sums_, begins);
}

DeviceCells::DeviceCells(Program& program, std::size_t particles, std::size_t cells)
    : begins(program, (cells + 1) * kCellNumber),
      cell_of(program, particles * kCellNumber),
      rank(program, particles * kCellNumber),
      counts(program, cells * kCellNumber),
      unsorted(program, particles * kCellNumber),
      program_(program),
      count_(particles),
      cells_(cells),
      sums_(program, cells) {}

std::size_t DeviceCells::bytes_for(std::size_t particles, std::size_t cells) {
  return (3 * particles + 2 * cells + 1) * kCellNumber + DevicePrefixSums::bytes_for(cells);
}

void DeviceCells::clear() {
  program_.fill_with_zeros(counts, cells_ * kCellNumber);
}

void DeviceCells::sort() {
  sums_.sum(counts, begins);
  program_.run("scatter", count_, static_cast<std::int32_t>(count_), cell_of, rank, begins,
               unsorted);
}

}  // namespace vat
