#pragma once

#include <optional>
#include <vector>

#include "core/scene/interface.h"
#include "core/scene/material.h"
#include "core/support/check.h"

namespace vat {

/// Table of the interfaces of a scene, by pairs of materials, or by a material and the walls.
/// Materials are identified by their index.
class InterfaceTable {
 public:
  InterfaceTable(const std::vector<Material>& materials,
                 const std::vector<InterfaceDescription>& interfaces);

  /// Returns the index of the interface. An empty result means the default interface.
  std::optional<std::size_t> between(std::size_t material_a, std::size_t material_b) const {
    VAT_ASSERT(material_a < side_ && material_b < side_);
    return table_[material_a * side_ + material_b];
  }
  std::optional<std::size_t> with_walls(std::size_t material) const {
    VAT_ASSERT(material + 1 < side_);
    return table_[material * side_ + side_ - 1];
  }

 private:
  std::size_t side_;  // number of materials plus one for the walls
  std::vector<std::optional<std::size_t>> table_;
};

/// Returns the index of the material with this name, or the number of materials if the name is
/// unknown.
std::size_t material_index(const std::vector<Material>& materials, const std::string& name);

}  // namespace vat
