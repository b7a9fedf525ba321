#include "core/device/contact/solid_geometry.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/device/common/kernel_values.h"
#include "core/device/common/vat_box.h"
#include "core/laws/vat_motion.h"
#include "core/limits.h"
#include "core/liquid/gas/liquid.h"
#include "core/model/acting_forces.h"
#include "core/support/check.h"

namespace vat {
namespace {

constexpr Real kMostSolidCells = 4096;  // in addition to those in proportion to the particles

}  // namespace

bool solids_move(const Model& model) {
  return model.free_count > model.liquid_count ||
         std::ranges::any_of(model.rigid_bodies, [&](const RigidModel& rigid) {
           const BodyDescription& body = model.scene.bodies[rigid.body];
           return rigid.free_from != kNever || rigid.motion || !body.velocity.isZero(0) ||
                  !body.angular_velocity.isZero(0);
         });
}

void SolidGeometry::set_grid(const Model& model) {
  const auto [low, high] = box_of_cells(model);
  const Real most = kMostSolidCells + 4 * static_cast<Real>(SolidRange(model).count);
  const Real extent = (high - low).maxCoeff();
  Real cell = std::max(model.contact_reach, extent / kMostSolidCells);
  if (SolidRange(model).liquids > 0) cell = std::max(cell, greatest_support(model));
  if (cell == 0) cell = 1;  // a single particle
  Real count = 0;
  do {
    count = 1;
    for (int k = 0; k < 3; ++k) {
      const Real along = std::max(Real{1}, std::ceil((high[k] - low[k]) / cell));
      constant_.cells[k] = static_cast<std::int32_t>(along);
      count *= along;
    }
    constant_.inverse_cell = 1 / cell;
    cell *= 2;
  } while (count > most);
  store(low, constant_.origin);
  for (int axis = 0; axis < 3; ++axis) {
    constant_.period[axis] = model.periodic.repeats(axis) ? model.periodic.length(axis) : 0;
  }
}

SolidGeometry::SolidGeometry(const Model& model, const GuardBounds& bounds) {
  const SolidRange range(model);
  VAT_CHECK(range.count > 0);
  set_grid(model);
  const Scene& scene = model.scene;
  store(scene.forces.gravity ? scene.gravity : Vec3(Vec3::Zero()), constant_.gravity);
  store_central_field(scene, constant_);
  store(bounds.min, constant_.domain_low);
  store(bounds.max, constant_.domain_high);
  constant_.reach = has_contact_forces(model) ? model.contact_reach : 0;
  constant_.step = scene.numerics.step;
  constant_.max_speed = kMaxSpeed;
  for (int axis = 0; axis < 3; ++axis) {
    constant_.wall_low[axis] = -std::numeric_limits<double>::infinity();
    constant_.wall_high[axis] = std::numeric_limits<double>::infinity();
  }
  for (const int wall : model.walls) {
    const int axis = wall / 2;
    constant_.walls |= 1 << wall;
    (wall % 2 == 0 ? constant_.wall_low : constant_.wall_high)[axis] =
        (wall % 2 == 0 ? scene.vat->min : scene.vat->max)[axis];
    const Vec3& speed = scene.vat->walls[static_cast<std::size_t>(wall)].velocity;
    for (int k = 0; k < 3; ++k) constant_.speeds_of_walls[3 * wall + k] = speed[k];
  }
  constant_.walls_push = has_wall_forces(model) ? 1 : 0;
  constant_.free = static_cast<std::int32_t>(range.free);
  constant_.count = static_cast<std::int32_t>(range.count);
  constant_.first = static_cast<std::int32_t>(range.first);
  constant_.liquids = static_cast<std::int32_t>(range.liquids);
  constant_.implicit = static_cast<std::int32_t>(model.implicit_begin - range.first);
  constant_.materials = static_cast<std::int32_t>(scene.materials.size());
  constant_.dimensions = scene.dimensions;
}

SolidParameters SolidGeometry::at(const Model& model, const StepMoment& moment) const {
  SolidParameters p = constant_;
  const Scene& scene = model.scene;
  const VatMotion motion = scene.vat ? vat_motion(*scene.vat, moment.time) : VatMotion{};
  store(motion.offset, p.offset);
  store(motion.velocity, p.wall_velocity);
  for (const int wall : model.walls) {
    (wall % 2 == 0 ? p.plane_low : p.plane_high)[wall / 2] =
        plane_of_wall(*scene.vat, motion, wall);
  }
  p.closing = moment.closing;
  p.opening = moment.opening;
  p.drift = moment.drift;
  p.prediction = moment.prediction;
  // A solve starts from predicted velocities of liquids; see evaluate_at_end().
  p.prediction_of_liquids = model.damping.any ? moment.opening : 0;
  return p;
}

std::size_t SolidGeometry::cell_count() const {
  std::size_t count = 1;
  for (const std::int32_t along : constant_.cells) count *= static_cast<std::size_t>(along);
  return count;
}

}  // namespace vat
