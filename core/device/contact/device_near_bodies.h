#pragma once

#include <cstddef>
#include <cstdint>

#include "core/device/opencl/program.h"
#include "core/model/model.h"

namespace vat {

/// Rigid bodies that may touch others, on a device. Other particles of rigid bodies need no search
/// for contacts. Used only if all solids are rigid bodies in a world without periodic axes, and if
/// the search for bodies costs less than one for particles. The functions throw
/// opencl::DeviceFailure.
class DeviceNearBodies {
 public:
  /// The struct NearSearch of near_bodies.cl.
  struct Search {
    std::int32_t is_used;
    std::int32_t count;
    double reach;
  };

  /// `free` is the number of particles that are not of rigid bodies, but can have contacts.
  DeviceNearBodies(opencl::Program& program, const Model& model, std::size_t free);

  /// Returns the bytes of the buffers.
  static std::size_t bytes_for(const Model& model, std::size_t free);

  /// Finds the bodies for the present poses. `rigid` and `poses` are tables of rigid.cl.
  void find(const opencl::Buffer& rigid, const opencl::Buffer& poses);

  const Search& search() const { return search_; }

  opencl::Buffer spheres, counts, near;

 private:
  opencl::Program& program_;
  const Search search_;
};

}  // namespace vat
