#include "core/model/limited_springs.h"

#include <algorithm>
#include <utility>

namespace vat {
namespace {

std::vector<LimitedSpring> list_limited(const Model& model) {
  std::vector<LimitedSpring> springs;
  for (Index i = model.liquid_count; i < model.free_count; ++i) {
    const std::optional<Real>& limit = model.scene.materials[model.material[i]].elongation_limit;
    if (!limit) continue;
    for (Index e = model.spring_begin[i]; e < model.spring_begin[i + 1]; ++e) {
      const SpringEnd& spring = model.spring_ends[e];
      const bool can_move = model.inverse_mass[i] + model.inverse_mass[spring.other] > 0;
      if (spring.other < i || spring.rest_length == 0 || !can_move) continue;
      springs.push_back({i, spring.other, e, (1 + *limit) * spring.rest_length});
    }
  }
  return springs;
}

}  // namespace

void find_limited_springs(Model& model) {
  const std::vector<LimitedSpring> limited = list_limited(model);
  std::vector<std::vector<LimitedSpring>> colours;
  std::vector<std::vector<bool>> is_taken(limited.empty() ? 0 : model.free_count);  // and colour
  const auto has = [&](Index i, std::size_t colour) {
    return colour < is_taken[i].size() && is_taken[i][colour];
  };
  for (const LimitedSpring& spring : limited) {
    std::size_t colour = 0;
    while (has(spring.a, colour) || has(spring.b, colour)) ++colour;
    if (colours.size() <= colour) colours.resize(colour + 1);
    for (const Index i : {spring.a, spring.b}) {
      is_taken[i].resize(std::max(is_taken[i].size(), colour + 1));
      is_taken[i][colour] = true;
    }
    colours[colour].push_back(spring);
  }
  std::vector<LimitedSpring> springs;
  std::vector<Index> begins = {0};
  for (const std::vector<LimitedSpring>& colour : colours) {
    springs.insert(springs.end(), colour.begin(), colour.end());
    begins.push_back(static_cast<Index>(springs.size()));
  }
  model.limited_springs = std::move(springs);
  model.limited_begin = std::move(begins);
}

}  // namespace vat
