#include "tests/bench/speed/neighbours.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

namespace vat::bench {

namespace {

constexpr std::int64_t kCellsPerAxis = 1 << 20;  // maximum of a lattice in a scene

/// Points sorted by cubic cells, independent of the core's search.
class Cells {
 public:
  Cells(std::vector<Vec3> points, Real size) : points_(std::move(points)), size_(size) {
    std::ranges::sort(points_, {}, [this](const Vec3& p) { return key(cell(p)); });
    for (const Vec3& p : points_) keys_.push_back(key(cell(p)));
  }

  std::size_t count_near(const Vec3& p) const {
    std::size_t count = 0;
    const Cell middle = cell(p);
    for (std::int64_t z = -1; z <= 1; ++z) {
      for (std::int64_t y = -1; y <= 1; ++y) {
        const std::int64_t row = key({middle.x, middle.y + y, middle.z + z});
        const auto begin = std::ranges::lower_bound(keys_, row - 1);
        const auto end = std::upper_bound(begin, keys_.end(), row + 1);
        for (auto at = begin; at != end; ++at) {
          const Vec3& q = points_[static_cast<std::size_t>(at - keys_.begin())];
          count += (p - q).squaredNorm() < size_ * size_ ? 1u : 0u;
        }
      }
    }
    return count;
  }

 private:
  struct Cell {
    std::int64_t x, y, z;
  };
  Cell cell(const Vec3& p) const {
    const auto at = [this](Real x) { return static_cast<std::int64_t>(std::floor(x / size_)); };
    return {at(p.x()), at(p.y()), at(p.z())};
  }
  static std::int64_t key(const Cell& c) {
    return (c.z * kCellsPerAxis + c.y) * kCellsPerAxis + c.x;
  }

  std::vector<Vec3> points_;
  Real size_;
  std::vector<std::int64_t> keys_;
};

/// Adds the images of points within `reach` of the walls of each axis, including images of images
/// at other axes.
void add_images(const Simulation& simulation, Real reach, std::vector<Vec3>& points) {
  const Vat& vat = *simulation.scene().vat;
  for (int axis = 0; axis < 3; ++axis) {
    if (axis == 1 && simulation.scene().dimensions == 2) continue;
    const bool has_top = axis < 2 || vat.lid;
    const Real low = vat.min[axis] + simulation.vat_offset()[axis];
    const Real high = vat.max[axis] + simulation.vat_offset()[axis];
    for (std::size_t k = points.size(); k-- > 0;) {
      Vec3 image = points[k];
      const Real p = image[axis];
      if (p - low < reach) {
        image[axis] = 2 * low - p;
        points.push_back(image);
      }
      if (has_top && high - p < reach) {
        image[axis] = 2 * high - p;
        points.push_back(image);
      }
    }
  }
}

Real support_radius_of(const Scene& scene, std::string_view material) {
  const auto found = std::ranges::find(scene.materials, material, &Material::name);
  return found->liquid->support_radius;
}

}  // namespace

Real mean_neighbours(const Simulation& simulation) {
  const Scene& scene = simulation.scene();
  if (scene.periodic) return std::numeric_limits<Real>::quiet_NaN();
  std::vector<Vec3> points;
  for (const BodyView& body : simulation.bodies()) {
    if (body.kind != BodyKind::liquid && scene.pressure_solver == PressureSolver::gas) continue;
    points.insert(points.end(), body.positions.begin(), body.positions.end());
  }
  std::size_t particles = 0;
  std::size_t neighbours = 0;
  for (const BodyView& body : simulation.bodies()) {
    if (body.kind != BodyKind::liquid || body.positions.empty()) continue;
    const Real reach = support_radius_of(scene, body.material);
    std::vector<Vec3> all = points;
    if (scene.vat && scene.pressure_solver != PressureSolver::gas) {
      add_images(simulation, reach, all);
    }
    const Cells cells(std::move(all), reach);
    for (const Vec3& p : body.positions) neighbours += cells.count_near(p) - 1;
    particles += body.positions.size();
  }
  if (particles == 0) return std::numeric_limits<Real>::quiet_NaN();
  return static_cast<Real>(neighbours) / static_cast<Real>(particles);
}

}  // namespace vat::bench
