#pragma once

#include <algorithm>
#include <string>

#include "core/scene/scene.h"

namespace vat {

/// The material of a body. The scene must be valid: it has a material of this name.
inline const Material& material_of(const Scene& scene, const BodyDescription& body) {
  return *std::ranges::find(scene.materials, body.material, &Material::name);
}

/// JSON pointer to the body with this index in Scene::bodies.
inline std::string body_path(std::size_t index) {
  return "/bodies/" + std::to_string(index);
}

}  // namespace vat
