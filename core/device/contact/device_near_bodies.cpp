#include "core/device/contact/device_near_bodies.h"

#include <algorithm>

#include "core/device/common/kernel_values.h"
#include "core/model/acting_forces.h"

namespace vat {
namespace {

using Search = DeviceNearBodies::Search;

constexpr std::size_t kSpheresEnd = 8;       // SPHERES_END of near_bodies.cl
constexpr std::size_t kMostNearBodies = 24;  // MOST_NEAR_BODIES
/// Comparisons of bodies that cost as much as the search of a particle.
constexpr std::size_t kComparisons = 40;

Search search_of(const Model& model, std::size_t free) {
  const std::size_t bodies = model.rigid_bodies.size();
  const bool is_used = has_contact_forces(model) && free == 0 && !model.periodic.any() &&
                       bodies * bodies <= kComparisons * (model.particle_count - model.free_count);
  return {is_used ? 1 : 0, number_of(is_used ? bodies : 0), model.contact_reach};
}

std::size_t bytes_of_spheres(const Search& search) {
  return 4 * (static_cast<std::size_t>(search.count) + kSpheresEnd) * sizeof(double);
}
std::size_t bytes_of_counts(const Search& search) {
  return static_cast<std::size_t>(std::max(1, search.count)) * sizeof(std::int32_t);
}

}  // namespace

DeviceNearBodies::DeviceNearBodies(opencl::Program& program, const Model& model, std::size_t free)
    : spheres(program, bytes_of_spheres(search_of(model, free))),
      counts(program, bytes_of_counts(search_of(model, free))),
      near(program, kMostNearBodies * bytes_of_counts(search_of(model, free))),
      program_(program),
      search_(search_of(model, free)) {}

std::size_t DeviceNearBodies::bytes_for(const Model& model, std::size_t free) {
  const Search search = search_of(model, free);
  return bytes_of_spheres(search) + (1 + kMostNearBodies) * bytes_of_counts(search);
}

void DeviceNearBodies::find(const opencl::Buffer& rigid, const opencl::Buffer& poses) {
  if (search_.is_used == 0) return;
  const auto bodies = static_cast<std::size_t>(search_.count);
  program_.run("place_spheres", bodies, search_, rigid, poses, spheres);
  program_.run("find_near_bodies", bodies, search_, spheres, counts, near);
}

}  // namespace vat
