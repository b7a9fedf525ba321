#pragma once

#include <cstddef>

namespace vat {

/// The maximum size in bytes of Snapshot::to_bytes() for a simulation with these numbers of
/// particles and springs, from their written fields and the limits of all other data. Meshes count
/// with three vertices for each triangle.
std::size_t greatest_saved_size(std::size_t particles, std::size_t springs);

}  // namespace vat
