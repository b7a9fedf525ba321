#pragma once

namespace vat {

/// A box of twelve triangles, counter-clockwise if seen from outside.
inline MeshShape box_mesh(const Vec3& min, const Vec3& max) {
  MeshShape mesh;
  for (int corner = 0; corner < 8; ++corner) {
    mesh.vertices.emplace_back((corner & 1) != 0 ? max.x() : min.x(),
                               (corner & 2) != 0 ? max.y() : min.y(),
                               (corner & 4) != 0 ? max.z() : min.z());
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

/// Returns one mesh that contains both meshes.
inline MeshShape joined(MeshShape a, const MeshShape& b) {
  const auto first = static_cast<Index>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const auto& [p, q, r] : b.triangles) {
    a.triangles.push_back({p + first, q + first, r + first});
  }
  return a;
}

/// Returns the same surface with inverted orientation.
inline MeshShape inside_out(MeshShape mesh) {
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  return mesh;
}

}  // namespace vat
