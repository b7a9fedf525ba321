#include "core/sampling/mesh.h"
#include "core/support/check.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace vat {
namespace {

using Edge = std::pair<Index, Index>;

bool comes_before(const Vec3& a, const Vec3& b) {
  return std::tie(a[0], a[1], a[2]) < std::tie(b[0], b[1], b[2]);
}

/// For each vertex, the first one at the same position.
std::vector<Index> weld(const std::vector<Vec3>& vertices) {
  std::vector<Index> order(vertices.size());
  for (Index i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::stable_sort(
      order, [&](Index a, Index b) { return comes_before(vertices[a], vertices[b]); });
  std::vector<Index> welded(vertices.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && vertices[order[i]] == vertices[order[i - 1]];
    welded[order[i]] = same ? welded[order[i - 1]] : order[i];
  }
  return welded;
}

/// Returns whether a ray from (x, y) towards +x meets the edge. The ends are ordered first, so that
/// both triangles of an edge get the same answer.
bool ray_meets_edge(Real x, Real y, const Vec3& a, const Vec3& b) {
  if ((a.y() <= y) == (b.y() <= y)) return false;
  const bool in_order = a.y() < b.y();
  const Vec3& low = in_order ? a : b;
  const Vec3& high = in_order ? b : a;
  return x < low.x() + (y - low.y()) / (high.y() - low.y()) * (high.x() - low.x());
}

bool line_meets_triangle(Real x, Real y, const Vec3& a, const Vec3& b, const Vec3& c) {
  return ray_meets_edge(x, y, a, b) ^ ray_meets_edge(x, y, b, c) ^ ray_meets_edge(x, y, c, a);
}

}  // namespace

Real mesh_volume(const MeshShape& mesh) {
  if (mesh.vertices.empty()) return 0;
  const Vec3 origin = mesh.vertices.front();  // near the mesh, to avoid cancellation
  Real volume = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3 normal = (mesh.vertices[b] - origin).cross(mesh.vertices[c] - origin);
    volume += (mesh.vertices[a] - origin).dot(normal) / 6;
  }
  return volume;
}

bool is_closed(const MeshShape& mesh) {
  const std::vector<Index> welded = weld(mesh.vertices);
  std::vector<Edge> forward;
  std::vector<Edge> backward;
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Index from = welded[triangle[k]];
      const Index to = welded[triangle[(k + 1) % 3]];
      forward.emplace_back(from, to);
      backward.emplace_back(to, from);
    }
  }
  std::ranges::sort(forward);
  std::ranges::sort(backward);
  return !forward.empty() && forward == backward;
}

namespace {

struct LineRange {
  Index begin = 0;
  Index end = 0;
};

LineRange lines_between(const MeshLines& lines, Real low, Real high, std::size_t axis) {
  const Real first = lines.first[static_cast<Eigen::Index>(axis)];
  const Real count = lines.count[axis];
  // One more line on each side, because of rounding.
  const Real begin = std::floor((low - first) / lines.spacing);
  const Real end = std::ceil((high - first) / lines.spacing) + 1;
  return {static_cast<Index>(std::clamp(begin, Real{0}, count)),
          static_cast<Index>(std::clamp(end, Real{0}, count))};
}

struct Triangle {
  Triangle(const MeshShape& mesh, const std::array<Index, 3>& corners)
      : a(mesh.vertices[corners[0]]),
        b(mesh.vertices[corners[1]]),
        c(mesh.vertices[corners[2]]),
        low(a.cwiseMin(b).cwiseMin(c)),
        high(a.cwiseMax(b).cwiseMax(c)) {}
  const Vec3& a;
  const Vec3& b;
  const Vec3& c;
  Vec3 low;
  Vec3 high;
};

void add_crossings(const Triangle& t, const MeshLines& lines, std::vector<MeshCrossing>& found) {
  const Vec3 normal = (t.b - t.a).cross(t.c - t.a);
  if (normal.z() == 0) return;  // parallel to the lines: no crossing
  const LineRange columns = lines_between(lines, t.low.x(), t.high.x(), 0);
  const LineRange rows = lines_between(lines, t.low.y(), t.high.y(), 1);
  for (Index j = rows.begin; j < rows.end; ++j) {
    const Real y = lines.first.y() + j * lines.spacing;
    for (Index i = columns.begin; i < columns.end; ++i) {
      const Real x = lines.first.x() + i * lines.spacing;
      if (!line_meets_triangle(x, y, t.a, t.b, t.c)) continue;
      const Real slope = normal.x() * (x - t.a.x()) + normal.y() * (y - t.a.y());
      // Clamped, because steep triangles amplify the rounding errors of x and y.
      const Real z = std::clamp(t.a.z() - slope / normal.z(), t.low.z(), t.high.z());
      const std::size_t line = static_cast<std::size_t>(j) * lines.count[0] + i;
      VAT_CHECK(i < lines.count[0] && j < lines.count[1]);
      found.push_back({line, z, normal.z() > 0 ? 1 : -1});
    }
  }
}

}  // namespace

Real crossing_work(const MeshShape& mesh, const MeshLines& lines) {
  Real work = 0;
  for (const auto& corners : mesh.triangles) {
    const Triangle t(mesh, corners);
    const LineRange x = lines_between(lines, t.low.x(), t.high.x(), 0);
    const LineRange y = lines_between(lines, t.low.y(), t.high.y(), 1);
    work += static_cast<Real>(x.end - x.begin) * (y.end - y.begin);
  }
  return work;
}

std::vector<MeshCrossing> find_crossings(const MeshShape& mesh, const MeshLines& lines) {
  std::vector<MeshCrossing> found;
  for (const auto& corners : mesh.triangles) add_crossings(Triangle(mesh, corners), lines, found);
  std::ranges::stable_sort(found, {}, &MeshCrossing::line);
  return found;
}

}  // namespace vat
