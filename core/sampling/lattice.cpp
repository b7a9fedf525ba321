#include "core/sampling/lattice.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "core/sampling/mesh.h"
#include "core/support/check.h"

namespace vat {
namespace {

// Tolerance for shapes that hold a whole number of cells, up to rounding.
constexpr Real kRounding = 1e-9;

struct Bounds {
  Vec3 center;
  Vec3 size;
};

Bounds bounds_of(const BoxShape& box) {
  return {box.center, box.size};
}

Bounds bounds_of(const SphereShape& sphere) {
  return {sphere.center, Vec3::Constant(2 * sphere.radius)};
}

Bounds bounds_of(const CylinderShape& cylinder) {
  const Vec3 axis = cylinder.axis.normalized();
  const Vec3 across = (Vec3::Ones() - axis.cwiseAbs2()).cwiseMax(0).cwiseSqrt();
  return {cylinder.center, cylinder.height * axis.cwiseAbs() + 2 * cylinder.radius * across};
}

Bounds bounds_of(const MeshShape& mesh) {
  Vec3 low = mesh.vertices[mesh.triangles.front()[0]];
  Vec3 high = low;
  for (const auto& triangle : mesh.triangles) {
    for (const Index corner : triangle) {
      low = low.cwiseMin(mesh.vertices[corner]);
      high = high.cwiseMax(mesh.vertices[corner]);
    }
  }
  return {(low + high) / 2, high - low};
}

Bounds bounds_of(const ParticleShape&) {
  VAT_CHECK(false && "explicit particles have no lattice");
  return {};
}

bool contains(const BoxShape&, const Vec3&) {
  return true;  // the lattice covers the bounding box only
}

bool contains(const SphereShape& sphere, const Vec3& point) {
  return (point - sphere.center).norm() <= sphere.radius * (1 + kRounding);
}

bool contains(const CylinderShape& cylinder, const Vec3& point) {
  const Vec3 axis = cylinder.axis.normalized();
  const Vec3 from_center = point - cylinder.center;
  const Real along = from_center.dot(axis);
  return std::abs(along) <= cylinder.height / 2 * (1 + kRounding) &&
         (from_center - along * axis).norm() <= cylinder.radius * (1 + kRounding);
}

bool contains(const ParticleShape&, const Vec3&) {
  return false;
}

Vec3 point_at(const Lattice& lattice, Index i, Index j, Index k) {
  return lattice.first + lattice.spacing * Vec3(i, j, k);
}

template <class Contains>
std::vector<LatticePoint> keep_points(const Lattice& lattice, Contains&& contains_point) {
  std::vector<LatticePoint> points;
  for (Index k = 0; k < lattice.size[2]; ++k) {
    for (Index j = 0; j < lattice.size[1]; ++j) {
      for (Index i = 0; i < lattice.size[0]; ++i) {
        const Vec3 position = point_at(lattice, i, j, k);
        if (contains_point(position, i, j)) points.push_back({{i, j, k}, position});
      }
    }
  }
  return points;
}

MeshLines lines_of(const Lattice& lattice) {
  return {lattice.first,
          lattice.spacing,
          {static_cast<Index>(lattice.size[0]), static_cast<Index>(lattice.size[1])}};
}

std::vector<LatticePoint> fill_mesh(const MeshShape& mesh, const Lattice& lattice) {
  const std::vector<MeshCrossing> crossings = find_crossings(mesh, lines_of(lattice));
  const auto width = static_cast<std::size_t>(lattice.size[0]);
  VAT_CHECK(lattice.size[0] >= 1 && lattice.size[1] >= 1);
  std::vector<std::size_t> begin(width * static_cast<std::size_t>(lattice.size[1]) + 1);
  for (const MeshCrossing& crossing : crossings) ++begin[crossing.line + 1];
  for (std::size_t line = 1; line < begin.size(); ++line) begin[line] += begin[line - 1];
  return keep_points(lattice, [&](const Vec3& point, Index i, Index j) {
    const std::size_t line = j * width + i;
    int winding = 0;
    for (std::size_t c = begin[line]; c < begin[line + 1]; ++c) {
      if (crossings[c].z > point.z()) winding += crossings[c].turn;
    }
    return winding > 0;
  });
}

}  // namespace

Lattice make_lattice(const Shape& shape, Real spacing, int dimensions) {
  VAT_CHECK(spacing > 0);
  const Bounds bounds = std::visit([](const auto& s) { return bounds_of(s); }, shape);
  Lattice lattice;
  lattice.spacing = spacing;
  lattice.first = bounds.center;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<Eigen::Index>(axis);
    const bool flat = dimensions == 2 && axis == 1;
    const Real cells = flat ? 1 : std::floor(bounds.size[a] / spacing + kRounding);
    lattice.size[axis] = std::max(Real{1}, cells);
    lattice.first[a] -= spacing * (lattice.size[axis] - 1) / 2;
  }
  return lattice;
}

Real lattice_work(const MeshShape& mesh, const Lattice& lattice) {
  return crossing_work(mesh, lines_of(lattice));
}

std::vector<LatticePoint> fill_lattice(const Shape& shape, const Lattice& lattice) {
  if (const auto* mesh = std::get_if<MeshShape>(&shape)) return fill_mesh(*mesh, lattice);
  return std::visit(
      [&](const auto& s) {
        if constexpr (std::is_same_v<std::decay_t<decltype(s)>, MeshShape>) {
          return std::vector<LatticePoint>{};
        } else {
          return keep_points(lattice,
                             [&](const Vec3& point, Index, Index) { return contains(s, point); });
        }
      },
      shape);
}

}  // namespace vat
