#include <algorithm>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

#include "core/model/compile_parts.h"
#include "core/numerics/band_factor.h"
#include "core/support/check.h"

namespace vat {
namespace {

/// Graph of the free particles of one body and of the springs between them.
class SpringGraph {
 public:
  SpringGraph(const Model& model, const IndexRange& particles)
      : model_(model), first_(particles.begin), begin_(particles.size() + std::size_t{1}, 0) {
    for (Index i = 0; i < particles.size(); ++i) {
      for (Index e = model.spring_begin[first_ + i]; e < model.spring_begin[first_ + i + 1]; ++e) {
        const Index other = model.spring_ends[e].other - first_;
        if (is_free(i) && is_free(other) && other != i) others_.push_back(other);
      }
      begin_[i + 1] = static_cast<Index>(others_.size());
    }
    for (Index i = 0; i < size(); ++i) {
      std::stable_sort(others_.begin() + begin_[i], others_.begin() + begin_[i + 1],
                       [&](Index a, Index b) { return degree(a) < degree(b); });
    }
  }

  Index size() const { return static_cast<Index>(begin_.size() - 1); }
  Index degree(Index i) const { return begin_[i + 1] - begin_[i]; }
  std::span<const Index> others(Index i) const {
    return std::span(others_).subspan(begin_[i], degree(i));
  }

 private:
  bool is_free(Index i) const { return model_.inverse_mass[first_ + i] > 0; }

  const Model& model_;
  Index first_;
  std::vector<Index> begin_;
  std::vector<Index> others_;  ///< by ascending degree
};

/// Appends the connected part of `start`, by ascending distance in springs. Sets the distances.
/// Returns the greatest distance.
Index append_levels(const SpringGraph& graph, Index start, std::vector<Index>& order,
                    std::vector<Index>& distance) {
  constexpr Index kUnknown = std::numeric_limits<Index>::max();
  std::size_t next = order.size();
  order.push_back(start);
  distance[start] = 0;
  for (; next < order.size(); ++next) {
    for (const Index other : graph.others(order[next])) {
      if (distance[other] != kUnknown) continue;
      distance[other] = distance[order[next]] + 1;
      order.push_back(other);
    }
  }
  return distance[order.back()];
}

/// Returns the particles in reverse Cuthill-McKee order (E. Cuthill, J. McKee, Proc. 24th Nat.
/// Conf. ACM (1969) 157). Each part starts at a particle that is far from the others (A. George, J.
/// W. H. Liu, ACM Trans. Math. Softw. 5 (1979) 284).
std::vector<Index> order_by_levels(const SpringGraph& graph) {
  constexpr Index kUnknown = std::numeric_limits<Index>::max();
  std::vector<Index> by_degree(graph.size());
  std::iota(by_degree.begin(), by_degree.end(), Index{0});
  std::ranges::stable_sort(by_degree, {}, [&](Index i) { return graph.degree(i); });
  std::vector<Index> order;
  std::vector<Index> distance(graph.size(), kUnknown);
  for (const Index first : by_degree) {
    if (distance[first] != kUnknown) continue;
    const std::size_t begin = order.size();
    Index reached = append_levels(graph, first, order, distance);
    for (bool is_farther = true; is_farther;) {
      const Index start = order.back();
      for (std::size_t k = begin; k < order.size(); ++k) distance[order[k]] = kUnknown;
      order.resize(begin);
      const Index farther = append_levels(graph, start, order, distance);
      is_farther = farther > reached;
      reached = farther;
    }
  }
  std::ranges::reverse(order);
  return order;
}

Index width_of(const SpringGraph& graph, std::span<const Index> places) {
  Index width = 0;
  for (Index i = 0; i < graph.size(); ++i) {
    for (const Index other : graph.others(i)) {
      if (places[other] < places[i]) width = std::max(width, places[i] - places[other]);
    }
  }
  return width;
}

}  // namespace

void order_implicit_springs(Model& model) {
  std::vector<Index> all_places(model.free_count - model.implicit_begin);
  for (ModelBody& body : model.bodies) {
    const IndexRange& particles = body.particles;
    if (particles.begin < model.implicit_begin || particles.end > model.free_count) continue;
    const SpringGraph graph(model, particles);
    const std::span<Index> places =
        std::span(all_places).subspan(particles.begin - model.implicit_begin, particles.size());
    Index place = 0;
    for (const Index particle : order_by_levels(graph)) places[particle] = place++;
    VAT_CHECK(place == particles.size());
    const Index width = width_of(graph, places);
    if (width <= BandFactor::kMaxWidth) body.spring_width = width;
  }
  model.implicit_places = std::move(all_places);
}

}  // namespace vat
