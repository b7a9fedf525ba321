#pragma once

#include <string>

#include "core/scene/range_check.h"
#include "core/scene/scene.h"

/// The checks of validate.cpp for the parts of a scene, one by one. Paths are JSON pointers.
namespace vat {

void check_constants(const SpringConstants& constants, const std::string& path, RangeCheck& check);

/// Particles and springs that a body will have; zero where it has errors.
struct BodySize {
  std::size_t particles = 0;
  std::size_t springs = 0;
};

/// Everything about a body but its name's uniqueness and the scene's totals.
BodySize check_body(const Scene& scene, const BodyDescription& body, const std::string& path,
                    RangeCheck& check);

/// Ranges of the shape's own values, and for meshes whether they can be filled. True where the
/// shape can be sampled.
bool check_shape(const BodyDescription& body, const std::string& path, RangeCheck& check);

}  // namespace vat
