// Limits of saved states and scenes.

#include <cstddef>

#include "server/storage/saved/saved_scenes.h"
#include "server/storage/saved/saved_states.h"

namespace vat {
namespace {

template <std::size_t Count>
std::optional<LimitExcess> first_excess(const std::size_t (&wanted)[Count],
                                        const LimitExcess (&limits)[Count]) {
  for (std::size_t i = 0; i < Count; ++i) {
    if (wanted[i] > limits[i].maximum) return limits[i];
  }
  return {};
}

}  // namespace

std::optional<LimitExcess> find_excess(const SavedStateUse& use, std::size_t bytes,
                                       const SavedStateLimits& limits) {
  return first_excess({use.in_session + 1, use.bytes_in_session + bytes, use.bytes_in_all + bytes},
                      {{"states_per_session", limits.per_session},
                       {"state_bytes_per_session", limits.bytes_per_session},
                       {"state_bytes_in_all", limits.bytes_in_all}});
}

std::optional<LimitExcess> find_excess(const SavedSceneUse& use, std::size_t bytes,
                                       const SavedSceneLimits& limits) {
  return first_excess(
      {use.of_address + 1, use.bytes_of_address + bytes, use.in_all + 1, use.bytes_in_all + bytes},
      {{"scenes_per_address", limits.per_address},
       {"scene_bytes_per_address", limits.bytes_per_address},
       {"scenes_in_all", limits.in_all},
       {"scene_bytes_in_all", limits.bytes_in_all}});
}

}  // namespace vat
