#include "core/device/liquid/device_particles.h"

#include "core/support/check.h"

namespace vat {
namespace {

using opencl::Program;

// Constants of cells.cl and pairs.cl.
constexpr std::size_t kScanBlock = 1024;
constexpr std::size_t kListLength = 64;
constexpr std::size_t kListGroup = 32;

constexpr std::size_t kNumber = sizeof(std::int32_t);

std::size_t list_entries(std::size_t particles) {
  return (particles + kListGroup - 1) / kListGroup * kListGroup * kListLength;
}

std::size_t scan_blocks(std::size_t cells) {
  return (cells + kScanBlock - 1) / kScanBlock;
}

}  // namespace

DeviceParticles::DeviceParticles(Program& program, const Model& model,
                                 const LiquidGeometry& geometry)
    : order(program, model.particle_count * kNumber),
      sorted_place(program, model.particle_count * sizeof(Float4)),
      sorted_motion(program, model.particle_count * sizeof(Float4)),
      density(program, model.particle_count * sizeof(float)),
      neighbour_counts(program, model.particle_count * kNumber),
      neighbours(program, list_entries(model.particle_count) * kNumber),
      cell_begins(program, (geometry.cell_count() + 1) * kNumber),
      counters(program, sizeof(Counters)),
      program_(program),
      liquid_count_(model.liquid_count),
      count_(model.particle_count),
      cells_(geometry.cell_count()),
      weight_(program, count_ * sizeof(float)),
      place_(program, count_ * sizeof(Float4)),
      motion_(program, count_ * sizeof(Float4)),
      cell_of_(program, count_ * kNumber),
      rank_(program, count_ * kNumber),
      unsorted_(program, count_ * kNumber),
      cell_counts_(program, cells_ * kNumber),
      block_sums_(program, scan_blocks(cells_) * kNumber) {
  const Real scale = model.liquids[model.material[0]]->kernel.scale();
  std::vector<float> weights;
  for (std::size_t i = 0; i < count_; ++i) {
    const auto weight = static_cast<float>(model.rest_volume[i] * scale);
    weights.push_back(i < liquid_count_ ? weight : -weight);
  }
  if (count_ > liquid_count_) {
    solid_position_ = opencl::Buffer(program, (count_ - liquid_count_) * sizeof(Vec3));
  }
  program_.write(weight_, std::span<const float>(weights));
}

std::size_t DeviceParticles::bytes_for(const Model& model, const LiquidGeometry& geometry) {
  const std::size_t solids = model.particle_count - model.liquid_count;
  return model.particle_count * (4 * sizeof(Float4) + 7 * kNumber) + solids * sizeof(Vec3) +
         list_entries(model.particle_count) * kNumber + geometry.cell_count() * 2 * kNumber;
}

void DeviceParticles::sort() {
  const auto cells = static_cast<std::int32_t>(cells_);
  const auto count = static_cast<std::int32_t>(count_);
  const std::size_t blocks = scan_blocks(cells_);
  const std::size_t scanners = blocks * Program::kGroup;
  program_.run("sum_blocks", scanners, cells, cell_counts_, block_sums_);
  program_.run("scan_sums", Program::kGroup, static_cast<std::int32_t>(blocks), block_sums_);
  program_.run("scan_blocks", scanners, cells, cell_counts_, block_sums_, cell_begins);
  program_.run("scatter", count_, count, cell_of_, rank_, cell_begins, unsorted_);
  program_.run("collect", count_, count, cell_of_, cell_begins, unsorted_, place_, motion_, order,
               sorted_place, sorted_motion);
}

void DeviceParticles::write_solids(const Configuration& from) {
  VAT_CHECK(from.position.size() == count_);
  if (count_ == liquid_count_) return;
  program_.write(solid_position_, std::span(from.position).subspan(liquid_count_));
}

void DeviceParticles::find_solid_pressure(const LiquidParameters& p) {
  if (count_ == liquid_count_) return;
  program_.run("find_solid_pressure", count_, p, cell_begins, sorted_place, sorted_motion, density,
               neighbour_counts, neighbours);
}

void DeviceParticles::clear_counters() {
  program_.fill_with_zeros(counters, sizeof(Counters));
}

Counters DeviceParticles::read_counters() {
  Counters read;
  program_.read(counters, std::span(&read, 1));
  return read;
}

}  // namespace vat
