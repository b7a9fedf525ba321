#include "core/device/common/vat_box.h"

#include <cmath>
#include <limits>
#include <memory>

#include "core/limits.h"
#include "core/model/compile.h"

namespace vat {

namespace {

/// The bodies at time 0, with half their extent around them.
std::array<Vec3, 2> box_of_bodies(const Model& model) {
  Vec3 low = Vec3::Constant(std::numeric_limits<Real>::infinity());
  Vec3 high = -low;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const std::shared_ptr<const SampledBody> sample = sample_of(model, b);
    for (const Vec3& position : sample->positions) {
      low = low.cwiseMin(position);
      high = high.cwiseMax(position);
    }
  }
  const Vec3 margin = (high - low) / 2;
  return {low - margin, high + margin};
}

}  // namespace

std::array<Vec3, 2> box_of_cells(const Model& model) {
  // Along periodic axes, the vat has the extent of the world.
  if (model.scene.vat) return {model.scene.vat->min, model.scene.vat->max};
  std::array<Vec3, 2> box = box_of_bodies(model);
  for (int axis = 0; axis < 3; ++axis) {
    if (!model.periodic.repeats(axis)) continue;
    box[0][axis] = model.scene.periodic->min[axis];
    box[1][axis] = model.scene.periodic->max[axis];
  }
  return box;
}

Real plane_of_wall(const Vat& vat, const VatMotion& motion, int wall) {
  const int axis = wall / 2;
  Vec3 p = Vec3::Zero();
  p[axis] = (wall % 2 == 0 ? vat.min : vat.max)[axis] + motion.offset[axis];
  const Real inwards = wall % 2 == 0 ? kMaxLength : -kMaxLength;
  while (wall_distance(vat, motion, wall, p) < 0) p[axis] = std::nextafter(p[axis], inwards);
  return p[axis];
}

}  // namespace vat
