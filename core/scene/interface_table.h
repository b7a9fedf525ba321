#pragma once

#include <optional>
#include <vector>

#include "core/scene/scene.h"

namespace vat {

/// Which of a scene's interfaces joins two materials, or a material and the walls. Materials are
/// told by their place in the list.
class InterfaceTable {
 public:
  InterfaceTable(const std::vector<Material>& materials,
                 const std::vector<InterfaceDescription>& interfaces);

  /// Place in the list of interfaces; none: the default interface.
  std::optional<std::size_t> between(std::size_t material_a, std::size_t material_b) const {
    return table_[material_a * side_ + material_b];
  }
  std::optional<std::size_t> with_walls(std::size_t material) const {
    return table_[material * side_ + side_ - 1];
  }

 private:
  std::size_t side_;  // the materials, and the walls last
  std::vector<std::optional<std::size_t>> table_;
};

/// Place of the material with this name; the number of materials if there is none.
std::size_t material_index(const std::vector<Material>& materials, const std::string& name);

}  // namespace vat
