#include "core/scene/interface_table.h"

#include <algorithm>

#include "core/support/check.h"

namespace vat {

InterfaceTable::InterfaceTable(const std::vector<Material>& materials,
                               const std::vector<InterfaceDescription>& interfaces)
    : side_(materials.size() + 1), table_(side_ * side_) {
  for (std::size_t i = 0; i < interfaces.size(); ++i) {
    const auto& [first, second] = interfaces[i].materials;
    // No material has the name of the walls, so that its index is the one after the last material.
    const std::size_t a = material_index(materials, first);
    const std::size_t b = material_index(materials, second);
    VAT_ASSERT((a + 1 < side_ || first == kVatMaterial) &&
               (b + 1 < side_ || second == kVatMaterial));
    table_[a * side_ + b] = i;
    table_[b * side_ + a] = i;
  }
}

std::size_t material_index(const std::vector<Material>& materials, const std::string& name) {
  return static_cast<std::size_t>(std::ranges::find(materials, name, &Material::name) -
                                  materials.begin());
}

}  // namespace vat
