#pragma once

#include <algorithm>
#include <string>

#include "core/scene/scene.h"
#include "core/support/check.h"

namespace vat {

/// The material of a body. The scene must have a material with this name.
inline const Material& material_of(const Scene& scene, const BodyDescription& body) {
  const auto found = std::ranges::find(scene.materials, body.material, &Material::name);
  VAT_CHECK(found != scene.materials.end());
  return *found;
}

/// JSON pointer to the body with this index in Scene::bodies.
inline std::string body_path(std::size_t index) {
  return "/bodies/" + std::to_string(index);
}

}  // namespace vat
