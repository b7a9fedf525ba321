#pragma once

#include <algorithm>
#include <string>

#include "core/scene/scene.h"
#include "core/support/check.h"

namespace vat {

/// Returns the material of a body. The scene must contain a material with this name.
inline const Material& material_of(const Scene& scene, const BodyDescription& body) {
  const auto found = std::ranges::find(scene.materials, body.material, &Material::name);
  VAT_CHECK(found != scene.materials.end());
  return *found;
}

/// Returns the JSON pointer to the body with this index in Scene::bodies.
inline std::string body_path(std::size_t index) {
  return "/bodies/" + std::to_string(index);
}

}  // namespace vat
