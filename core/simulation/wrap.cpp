#include "core/simulation/wrap.h"

namespace vat {

void wrap_liquid(const Model& model, TaskRunner* runner, Configuration& configuration) {
  for_blocks(runner, model.liquid_count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      configuration.position[i] = model.periodic.wrap(configuration.position[i]);
    }
  });
}

}  // namespace vat
