#include "core/device/liquid/liquid_geometry.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <type_traits>

#include "core/device/common/kernel_values.h"
#include "core/device/common/vat_box.h"
#include "core/laws/vat_motion.h"
#include "core/limits.h"
#include "core/liquid/pairs/coupled_pairs.h"
#include "core/model/acting_forces.h"
#include "core/model/compile.h"
#include "core/support/check.h"

namespace vat {
namespace {

/// The range of integer positions, see particles.cl.
struct Places {
  int most_bits;   ///< of a support radius, exact in the precision of sums
  int least_bits;  ///< the same for large boxes
  Real limit;      ///< of positions
};
constexpr Places kSinglePlaces{23, 19, 0x1p29};
constexpr Places kDoublePlaces{52, 48, 0x1p59};

const Places& places_of(const Model& model) {
  return has_double_pairs(model) ? kDoublePlaces : kSinglePlaces;
}

constexpr Real kMostCells = 4096;

// Lists of neighbours. A compressed liquid has more neighbours than a liquid at rest.
constexpr int kLeastList = 64;
constexpr int kMostList = 256;  ///< MOST_NEIGHBOURS of lane_lists.cl
constexpr int kListStep = 16;
constexpr Real kListReserve = 1.6;  ///< length of a list / number of neighbours at rest

/// Returns the number of neighbours of a particle at rest, if all particles have the least volume
/// of `volumes`.
Real neighbours_at_rest(const Model& model, std::span<const Real> volumes) {
  const Real h = model.liquids[model.material[0]]->support_radius;
  constexpr Real kPi = std::numbers::pi;
  const Real reach = model.scene.dimensions == 2 ? kPi * h * h : 4 * kPi / 3 * h * h * h;
  return reach / std::ranges::min(volumes);
}

/// Returns the length of lists that are complete for most particles. Solids are on one side of a
/// particle of the liquid.
std::int32_t list_length_for(const Model& model) {
  const std::span volumes(model.rest_volume);
  Real count = neighbours_at_rest(model, volumes.first(model.liquid_count));
  if (model.particle_count > model.liquid_count) {
    const Real solid = neighbours_at_rest(model, volumes.subspan(model.liquid_count));
    count = std::max(count, (count + solid) / 2);
  }
  const Real length = std::clamp(kListReserve * count, Real{kLeastList}, Real{kMostList});
  return kListStep * static_cast<std::int32_t>(std::ceil(length / kListStep));
}

}  // namespace

LiquidParametersOf<float, std::int32_t> LiquidParameters::in_single_precision() const {
  LiquidParametersOf<float, std::int32_t> single{};
  const auto copy = [](const auto& from, auto& to) {
    static_assert(std::extent_v<std::remove_reference_t<decltype(from)>> ==
                  std::extent_v<std::remove_reference_t<decltype(to)>>);
    using To = std::remove_reference_t<decltype(to[0])>;
    std::ranges::transform(from, to, [](auto value) { return static_cast<To>(value); });
  };
  copy(origin, single.origin);
  single.inverse_unit = inverse_unit;
  copy(wall_low, single.wall_low);
  copy(wall_high, single.wall_high);
  copy(wall_velocity, single.wall_velocity);
  copy(period, single.period);
  copy(domain_low, single.domain_low);
  copy(domain_high, single.domain_high);
  single.greatest_speed2 = greatest_speed2;
  single.closing = closing;
  single.opening = opening;
  single.drift = drift;
  single.prediction = prediction;
  copy(field_center, single.field_center);
  single.field_strength = field_strength;
  copy(gravity, single.gravity);
  copy(still, single.still);
  single.drag = static_cast<float>(drag);
  copy(fall, single.fall);
  single.unit = static_cast<float>(unit);
  single.in_supports = static_cast<float>(in_supports);
  single.density = static_cast<float>(density);
  single.layer = static_cast<float>(layer);
  single.stiffness = static_cast<float>(stiffness);
  single.tension = static_cast<float>(tension);
  single.slope_factor = static_cast<float>(slope_factor);
  single.viscosity = static_cast<float>(viscosity);
  single.solid_factor = static_cast<float>(solid_factor);
  copy(speeds_of_walls, single.speeds_of_walls);
  copy(twice_low, single.twice_low);
  copy(twice_high, single.twice_high);
  copy(periods, single.periods);
  copy(cells, single.cells);
  single.cell_bits = cell_bits;
  single.reach = reach;
  single.support = static_cast<std::int32_t>(support);
  single.walls = walls;
  single.sides = sides;
  single.no_slip = no_slip;
  single.is_thick = is_thick;
  single.bounces = bounces;
  single.is_filled = is_filled;
  single.count = count;
  single.solids = solids;
  single.list_length = list_length;
  return single;
}

void remove_walls(LiquidParameters& parameters) {
  for (int axis = 0; axis < 3; ++axis) {
    parameters.wall_low[axis] = -std::numeric_limits<double>::infinity();
    parameters.wall_high[axis] = std::numeric_limits<double>::infinity();
  }
}

std::int32_t periodic_sides(const Model& model) {
  std::int32_t sides = 0;
  for (int axis = 0; axis < 3; ++axis) sides |= model.periodic.repeats(axis) ? 3 << (2 * axis) : 0;
  return sides;
}

/// A periodic box begins at the origin. Positions beyond the limit are invalid, so that a longer
/// period needs no exact value.
void LiquidGeometry::set_period(const Model& model) {
  const PeriodicBox& box = model.periodic;
  for (int axis = 0; axis < 3; ++axis) {
    if (!box.repeats(axis)) continue;
    constant_.period[axis] = box.length(axis);
    const Real places =
        std::min(box.length(axis) * constant_.inverse_unit, 2 * places_of(model).limit);
    constant_.periods[axis] = std::llround(places);
    constant_.twice_high[axis] = 2 * constant_.periods[axis];
  }
}

void LiquidGeometry::set_grid(const Model& model) {
  const auto [low, high] = box_of_cells(model);
  const Real support = model.liquids[model.material[0]]->support_radius;
  const Real extent = (high - low).maxCoeff() / support;
  // Twice the box fits into the integers if possible, with the finest unit.
  const auto [most_bits, least_bits, limit] = places_of(model);
  const int bits =
      std::clamp(static_cast<int>(std::floor(std::log2(limit / std::max(Real{1}, 2 * extent)))),
                 least_bits, most_bits);
  // A cell is half a support radius. In a large box, cells are larger, so that they are not much
  // more than the particles.
  int doublings = -1;
  while (true) {
    const Real cell = std::ldexp(support, doublings);
    Real count = 1;
    for (int k = 0; k < 3; ++k) {
      const Real along = std::max(Real{1}, std::ceil((high[k] - low[k]) / cell));
      count *= along;
      constant_.cells[k] = static_cast<std::int32_t>(std::min(along, Real{0x1p29}));
    }
    if (count <= kMostCells + 4 * static_cast<Real>(model.particle_count)) break;
    ++doublings;
  }
  origin_ = low;
  const Real unit = std::ldexp(support, -bits);
  constant_.cell_bits = bits + doublings;
  constant_.reach = doublings < 0 ? 2 : 1;
  constant_.support = std::int64_t{1} << bits;
  constant_.inverse_unit = 1 / unit;
  constant_.unit = unit;
  constant_.in_supports = std::ldexp(1.0, -bits);
  set_period(model);
}

LiquidGeometry::LiquidGeometry(const Model& model, const GuardBounds& bounds) {
  VAT_CHECK(model.liquid_count > 0);
  set_grid(model);
  const LiquidModel& liquid = *model.liquids[model.material[0]];
  store_central_field(model.scene, constant_);
  store(bounds.min, constant_.domain_low);
  store(bounds.max, constant_.domain_high);
  travel_ = bounds.travel[model.body[0]];
  constant_.greatest_speed2 = greatest_speed2(model.scene.numerics.step);
  constant_.density = (liquid.rest_density);
  constant_.stiffness = (liquid.rest_density * liquid.stiffness);
  constant_.tension = (liquid.tensile_strength);
  // The acceleration is force / mass, and mass / rest volume is the density.
  constant_.slope_factor = (slope_factor(model, liquid) / liquid.rest_density);
  constant_.viscosity = (liquid.central_viscosity / liquid.support_radius);
  // The weight of a particle is its rest volume times the scale of the kernel.
  constant_.solid_factor = (slope_factor(model, liquid) / liquid.kernel.scale());
  for (const int wall : model.walls) constant_.walls |= 1 << wall;
  constant_.sides = constant_.walls | periodic_sides(model);
  for (const int wall : model.no_slip_walls) constant_.no_slip |= 1 << wall;
  constant_.is_thick = is_thick(liquid, model.scene.dimensions) ? 1 : 0;
  constant_.bounces = model.is_incompressible ? 0 : 1;
  constant_.is_filled = model.is_filled ? 1 : 0;
  constant_.count = static_cast<std::int32_t>(model.liquid_count);
  constant_.solids = static_cast<std::int32_t>(model.particle_count - model.liquid_count);
  constant_.list_length = list_length_for(model);
}

LiquidParameters LiquidGeometry::at(const Model& model, const StepMoment& moment) const {
  LiquidParameters p = constant_;
  const Scene& scene = model.scene;
  const VatMotion motion = scene.vat ? vat_motion(*scene.vat, moment.time) : VatMotion{};
  const Vec3 origin = origin_ + motion.offset;
  store(origin, p.origin);
  store(motion.velocity, p.wall_velocity);
  const Vec3 gravity = scene.forces.gravity ? scene.gravity : Vec3(Vec3::Zero());
  const Vec3 fall = fall_in_vat(model, motion, Vec3::Zero());
  store(gravity, p.gravity);
  store(fall, p.fall);
  const LiquidModel& liquid = *model.liquids[model.material[0]];
  p.layer = (liquid.rest_density * fall.norm() * liquid.spacing);
  if (scene.settling && moment.time < scene.settling->until) {
    p.drag = (scene.settling->drag);
    store(motion.velocity, p.still);
  }
  remove_walls(p);
  for (const int wall : model.walls) {
    const int axis = wall / 2;
    const Real plane = plane_of_wall(*scene.vat, motion, wall);
    const std::int64_t twice = std::llround(2 * (plane - origin[axis]) * p.inverse_unit);
    (wall % 2 == 0 ? p.wall_low : p.wall_high)[axis] = plane;
    (wall % 2 == 0 ? p.twice_low : p.twice_high)[axis] = twice;
    const auto index = static_cast<std::size_t>(wall);
    const Vec3 velocity = motion.velocity + scene.vat->walls[index].velocity;
    for (int k = 0; k < 3; ++k) p.speeds_of_walls[3 * wall + k] = (velocity[k]);
  }
  p.closing = moment.closing;
  p.opening = moment.opening;
  p.drift = moment.drift;
  p.prediction = moment.prediction;
  return p;
}

Real LiquidGeometry::greatest_speed2(Real dt) const {
  const Real speed = std::min(kMaxSpeed, travel_ / dt);
  return speed * speed;
}

std::size_t LiquidGeometry::cell_count() const {
  std::size_t count = 1;
  for (const std::int32_t along : constant_.cells) count *= static_cast<std::size_t>(along);
  return count;
}

}  // namespace vat
