#pragma once

#include <cstddef>

namespace vat {

/// Returns the maximum size in bytes of Snapshot::to_bytes() for these numbers of particles and
/// springs. It is computed from their saved fields and the limits of all other data. Meshes count
/// with three vertices for each triangle.
std::size_t greatest_saved_size(std::size_t particles, std::size_t springs);

}  // namespace vat
