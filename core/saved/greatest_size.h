#pragma once

#include <cstddef>

namespace vat {

/// Returns the maximum size of Snapshot::to_bytes() [bytes] for these numbers of particles and
/// springs. The size follows from the saved fields of particles and springs, and from the limits of
/// all other data. Meshes are assumed to have three vertices for each triangle.
std::size_t greatest_saved_size(std::size_t particles, std::size_t springs);

}  // namespace vat
