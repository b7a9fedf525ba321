#include "core/device/liquid/device_particles.h"

#include "core/device/common/kernel_values.h"
#include "core/liquid/pairs/pair_sums.h"
#include "core/support/check.h"

namespace vat {
namespace {

using opencl::Program;

// A multiple of LIST_GROUP of neighbours.cl.
constexpr std::size_t kListGroup = 32;

constexpr std::size_t kLiquidNumbers = 7;

constexpr std::size_t kNumber = sizeof(std::int32_t);

std::size_t list_entries(std::size_t particles, const LiquidGeometry& geometry) {
  return (particles + kListGroup - 1) / kListGroup * kListGroup * geometry.list_length();
}

std::size_t column_numbers(std::size_t particles) {
  constexpr std::size_t kColumnEnd = 16;  // COLUMN_END of particles.cl
  return 3 * (particles + kColumnEnd);
}

}  // namespace

std::size_t slots_in_lanes(std::size_t particles) {
  constexpr std::size_t kLanes = opencl::kMostLanes;
  return (particles + kLanes - 1) / kLanes * kLanes;
}

DeviceParticles::DeviceParticles(Program& program, const Model& model,
                                 const LiquidGeometry& geometry, std::optional<MovingSolids> moving)
    : order(program, model.particle_count * kNumber),
      sorted_place(program, slots_in_lanes(model.particle_count) * 4 * bytes_of_real(model)),
      sorted_motion(program, slots_in_lanes(model.particle_count) * 4 * bytes_of_real(model)),
      density(program, model.particle_count * bytes_of_real(model)),
      neighbour_counts(program, slots_in_lanes(model.particle_count) * kNumber),
      neighbours(program, list_entries(model.particle_count, geometry) * kNumber),
      columns(program, column_numbers(model.particle_count) * kNumber),
      plain_counts(program, slots_in_lanes(model.particle_count) * kNumber),
      selected(program, sizeof kSelectedLanes),
      cells(program, model.particle_count, geometry.cell_count()),
      counters(program),
      program_(program),
      liquid_count_(model.liquid_count),
      count_(model.particle_count),
      weight_(program, count_ * bytes_of_real(model)),
      place_(program, count_ * 4 * bytes_of_real(model)),
      motion_(program, count_ * 4 * bytes_of_real(model)),
      moving_(moving),
      has_table_(has_table_of_liquids(model)) {
  if (has_table_) write_table(model);
  const Real scale = model.liquids[model.material[0]]->kernel.scale();
  std::vector<double> weights;
  for (std::size_t i = 0; i < count_; ++i) {
    const Real weight = model.rest_volume[i] * scale;
    weights.push_back(i < liquid_count_ ? weight : -weight);
  }
  if (count_ > liquid_count_ && !moving_) {
    solid_position_ = opencl::Buffer(program, (count_ - liquid_count_) * sizeof(Vec3));
  }
  write_reals(program_, weight_, weights);
  program_.write(selected, std::span<const std::array<std::uint8_t, 8>>(kSelectedLanes));
}

std::size_t DeviceParticles::bytes_for(const Model& model, const LiquidGeometry& geometry,
                                       bool solids_move) {
  const std::size_t at_rest = solids_move ? 0 : model.particle_count - model.liquid_count;
  const std::size_t slots = slots_in_lanes(model.particle_count);
  return model.particle_count * (10 * bytes_of_real(model) + kNumber) +
         slots * (8 * bytes_of_real(model) + 2 * kNumber) + at_rest * sizeof(Vec3) +
         (list_entries(model.particle_count, geometry) + column_numbers(model.particle_count)) *
             kNumber +
         sizeof kSelectedLanes +
         (has_table_of_liquids(model)
              ? 2 * model.particle_count +
                    model.liquids.size() * kLiquidNumbers * bytes_of_real(model)
              : 0) +
         DeviceCells::bytes_for(model.particle_count, geometry.cell_count());
}

void DeviceParticles::write_table(const Model& model) {
  const LiquidModel& first = *model.liquids[model.material[0]];
  std::vector<double> table;
  std::vector<std::uint8_t> index_of_material(model.liquids.size());
  for (std::size_t m = 0; m < model.liquids.size(); ++m) {
    if (!model.liquids[m]) continue;
    const LiquidModel& liquid = *model.liquids[m];
    index_of_material[m] = static_cast<std::uint8_t>(table.size() / kLiquidNumbers);
    const Real slope = slope_factor(model, liquid);
    // The members of Liquid, see particles.cl.
    const Real values[kLiquidNumbers] = {
        scale_factor(model, liquid),
        liquid.rest_density,
        liquid.rest_density * liquid.spacing / (first.rest_density * first.spacing),
        liquid.rest_density * liquid.stiffness,
        slope / liquid.rest_density,
        liquid.central_viscosity / liquid.support_radius,
        slope / slope_factor(model, first)};
    table.insert(table.end(), std::begin(values), std::end(values));
  }
  std::vector<std::uint8_t> indices(count_, index_of_material[model.material[0]]);
  for (std::size_t i = 0; i < liquid_count_; ++i) indices[i] = index_of_material[model.material[i]];
  liquids_ = opencl::Buffer(program_, table.size() * bytes_of_real(model));
  liquid_of_ = opencl::Buffer(program_, count_);
  liquid_in_ = opencl::Buffer(program_, count_);
  write_reals(program_, liquids_, table);
  program_.write(liquid_of_, std::span<const std::uint8_t>(indices));
}

void DeviceParticles::enter_solids(const LiquidParameters& p) {
  const std::size_t solids = count_ - liquid_count_;
  if (solids == 0) return;
  if (moving_) {
    program_.run("enter_moving_solids", solids, p, moving_->position, moving_->velocity, weight_,
                 place_, motion_, cells.cell_of, cells.rank, cells.counts, counters.buffer);
  } else {
    program_.run("enter_solids", solids, p, solid_position_, weight_, place_, motion_,
                 cells.cell_of, cells.rank, cells.counts, counters.buffer);
  }
}

void DeviceParticles::sort() {
  cells.sort();
  const auto collect = [&](const auto&... of_liquids) {
    program_.run("collect", count_, number_of(count_), cells.cell_of, cells.begins, cells.unsorted,
                 place_, motion_, order, sorted_place, sorted_motion, columns, of_liquids...);
  };
  if (has_table_) {
    collect(liquid_of_, liquid_in_);
  } else {
    collect();
  }
}

void DeviceParticles::write_solids(const Configuration& from) {
  VAT_CHECK(from.position.size() == count_);
  if (count_ == liquid_count_ || moving_) return;
  program_.write(solid_position_, std::span(from.position).subspan(liquid_count_));
}

void DeviceParticles::find_solid_pressure(const LiquidParameters& p) {
  if (count_ == liquid_count_) return;
  run_over_pairs("find_solid_pressure", p, cells.begins, sorted_place, sorted_motion, density,
                 neighbour_counts, neighbours);
}

void DeviceParticles::add_forces_on_solids(const LiquidParameters& p, const opencl::Buffer& force) {
  run_over_pairs("add_forces_on_solids", p, cells.begins, order, sorted_place, sorted_motion,
                 neighbour_counts, neighbours, force);
}

}  // namespace vat
