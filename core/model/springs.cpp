#include "core/model/compile_parts.h"

#include <algorithm>
#include <numeric>
#include <span>

#include "core/support/check.h"

namespace vat {
namespace {

/// The beginnings of lists of different lengths that are stored in sequence, and the end of the
/// last.
class ListLayout {
 public:
  explicit ListLayout(std::size_t lists) : begin_(lists + 1, 0) {}

  void count(Index list) { ++begin_[list + 1]; }
  /// Call it after all counts.
  void lay_out() { std::partial_sum(begin_.begin(), begin_.end(), begin_.begin()); }
  const std::vector<Index>& begin() const { return begin_; }
  std::vector<Index> take() && { return std::move(begin_); }

 private:
  std::vector<Index> begin_;
};

/// Adds the springs of one body at both ends, ordered by the other end, and for equal ends by the
/// sample. Uses a counting sort by the other end, and then one by the own end.
void add_springs_of(const ModelBody& body, const std::vector<Index>& begin,
                    std::vector<SpringEnd>& ends) {
  struct End {
    Index own;
    Index spring;
  };
  const std::vector<SampledSpring>& springs = body.sample->springs;
  const Index first = body.particles.begin;
  const auto next_places = [&] {
    return std::vector<Index>(begin.begin() + first, begin.begin() + body.particles.end);
  };
  std::vector<End> by_other(2 * springs.size());
  std::vector<Index> next = next_places();
  const Index offset = begin[first];
  for (Index s = 0; s < springs.size(); ++s) {
    by_other[next[springs[s].b]++ - offset] = {springs[s].a, s};
    by_other[next[springs[s].a]++ - offset] = {springs[s].b, s};
  }
  next = next_places();
  for (Index other = 0; other < body.particles.size(); ++other) {
    for (Index e = begin[first + other]; e < begin[first + other + 1]; ++e) {
      const End& end = by_other[e - offset];
      const SampledSpring& spring = springs[end.spring];
      ends[next[end.own]++] = {first + other, spring.stiffness, spring.damping, spring.rest_length};
    }
  }
}

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

void add_springs(Model& model) {
  ListLayout layout(model.free_count);
  for (const ModelBody& body : model.bodies) {
    if (!model.scene.forces.springs) break;
    for (const SampledSpring& spring : body.sample->springs) {
      layout.count(body.particles.begin + spring.a);
      layout.count(body.particles.begin + spring.b);
    }
  }
  layout.lay_out();
  VAT_CHECK(layout.begin().size() == model.free_count + std::size_t{1});
  std::vector<SpringEnd> ends(layout.begin().back());
  for (const ModelBody& body : model.bodies) {
    const bool has_springs = model.scene.forces.springs && !body.sample->springs.empty();
    if (has_springs) add_springs_of(body, layout.begin(), ends);
  }
  std::vector<Index> own_begin;
  own_begin.reserve(model.free_count);
  for (Index i = 0; i < model.free_count; ++i) {
    const auto of_particle =
        std::span(ends).subspan(layout.begin()[i], layout.begin()[i + 1] - layout.begin()[i]);
    const auto own = std::ranges::lower_bound(of_particle, i, {}, &SpringEnd::other);
    own_begin.push_back(layout.begin()[i] + static_cast<Index>(own - of_particle.begin()));
    const Material& material = model.scene.materials[model.material[i]];
    const bool may_change = material.plasticity || material.tearing_strain;
    model.springs_change = model.springs_change || (may_change && !of_particle.empty());
  }
  model.spring_begin = std::move(layout).take();
  model.spring_own_begin = std::move(own_begin);
  model.spring_ends = std::move(ends);
}

void add_cells(Model& model) {
  std::vector<VolumeCell> cells;
  ListLayout layout(model.free_count);
  const Index count = model.scene.dimensions == 3 ? 8 : 4;
  for (const ModelBody& body : model.bodies) {
    if (!model.scene.forces.springs) break;
    for (const SampledCell& sampled : body.sample->cells) {
      VolumeCell cell{{}, sampled.volume, model.scene.materials[body.material].bulk_modulus};
      for (Index c = 0; c < count; ++c) {
        cell.corners[c] = body.particles.begin + sampled.corners[c];
        layout.count(cell.corners[c]);
      }
      cells.push_back(cell);
    }
  }
  layout.lay_out();
  std::vector<CellCorner> corners(layout.begin().back());
  std::vector<Index> next(layout.begin().begin(), layout.begin().end() - 1);
  for (Index k = 0; k < cells.size(); ++k) {
    for (Index c = 0; c < count; ++c) corners[next[cells[k].corners[c]]++] = {k, c};
  }
  model.cells = std::move(cells);
  model.cell_begin = std::move(layout).take();
  model.cell_corners = std::move(corners);
}

void find_limited_springs(Model& model) {
  const std::vector<LimitedSpring> limited = list_limited(model);
  std::vector<std::vector<LimitedSpring>> colours;
  std::vector<std::vector<bool>> is_taken(
      limited.empty() ? 0 : model.free_count);  // by particle and colour
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
