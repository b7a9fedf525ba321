#pragma once

#include <cstddef>

namespace vat {

/// The most bytes that Snapshot::to_bytes() gives of a simulation with so many particles and
/// springs, from the fields that are written of each and the limits on all else. Vertices of meshes
/// are counted as three a triangle.
std::size_t greatest_saved_size(std::size_t particles, std::size_t springs);

}  // namespace vat
