#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "core/scene/appearance.h"
#include "core/types.h"
#include "server/output/mesh/shape_mesh.h"

namespace vat {

/// Document in binary glTF 2.0: one scene, whose root node turns the z axis upwards, one animation,
/// and one buffer. All functions return indices.
class GlbDocument {
 public:
  GlbDocument();

  /// Adds an accessor of positions, numbers of vertices, times or values of an animation.
  std::size_t add_positions(std::span<const Vec3> positions);
  std::size_t add_indices(const std::vector<std::array<Index, 3>>& triangles);
  std::size_t add_times(const std::vector<float>& times);
  std::size_t add_values(const char* type, const std::vector<float>& values);

  std::size_t add_material(const std::string& name, const Colour& colour, Real opacity,
                           Real roughness, Real metalness);
  std::size_t add_mesh(const SurfaceMesh& surface, std::size_t material);
  /// Adds the data of a surface, and returns a primitive for add_mesh().
  nlohmann::json triangles_of(const SurfaceMesh& surface, std::size_t material);
  /// Adds a mesh from a list of primitives.
  std::size_t add_mesh(nlohmann::json primitives);
  /// Adds a child of the root node.
  std::size_t add_node(nlohmann::json node);
  /// Adds an animation of a property of a node: "translation", "rotation" or "scale".
  void animate(std::size_t node, const char* property, const char* interpolation, std::size_t times,
               std::size_t values);

  /// Returns the file, or an empty text if it exceeds the 4 GiB of the format.
  std::string bytes() const;

 private:
  std::size_t add_accessor(nlohmann::json accessor, int target);
  void append_floats(std::span<const float> values);

  nlohmann::json json_;
  std::string buffer_;
  std::size_t view_begin_ = 0;  ///< of the accessor that is being added
};

}  // namespace vat
