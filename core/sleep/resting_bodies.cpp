#include "core/sleep/resting_bodies.h"
#include "core/support/check.h"

#include <algorithm>
#include <limits>

namespace vat {
namespace {

template <class Box>
Box grown(const Box& box, Real distance) {
  return {box.min().array() - distance, box.max().array() + distance};
}

}  // namespace

RestingBodies::Box RestingBodies::box_of(std::span<const Vec3> points) const {
  Box box;
  for (const Vec3& p : points) box.extend(p);
  for (int axis = 0; axis < 3; ++axis) {
    if (!periodic_.repeats(axis)) continue;
    box.min()[axis] = -std::numeric_limits<Real>::infinity();
    box.max()[axis] = std::numeric_limits<Real>::infinity();
  }
  return box;
}

void RestingBodies::build(const Model& model, const std::vector<Vec3>& positions,
                          const std::vector<Index>& bodies, Real distance) {
  periodic_ = model.periodic;
  std::vector<std::pair<Box, Index>> boxes;
  std::vector<Index> particles;
  for (const Index b : bodies) {
    const IndexRange& range = model.bodies[b].particles;
    VAT_CHECK(range.begin <= range.end && range.end <= positions.size());
    boxes.emplace_back(box_of(std::span(positions).subspan(range.begin, range.size())), b);
    for (Index i = range.begin; i < range.end; ++i) particles.push_back(i);
  }
  std::ranges::stable_sort(boxes, {}, [](const auto& each) { return each.first.min().x(); });
  place_.assign(model.bodies.size(), 0);
  Real furthest = -std::numeric_limits<Real>::infinity();
  for (const auto& [box, body] : boxes) {
    place_[body] = static_cast<Index>(bodies_.size());
    bodies_.push_back(body);
    boxes_.push_back(box);
    furthest_.push_back(furthest = std::max(furthest, box.max().x()));
  }
  if (!particles.empty()) particles_.build(model, positions, particles, distance);
}

void RestingBodies::find_candidates(std::span<const Vec3> points, Real distance,
                                    std::vector<Index>& candidates) const {
  candidates.clear();
  VAT_CHECK(furthest_.size() == bodies_.size() && boxes_.size() == bodies_.size());
  const Box wide = grown(box_of(points), distance);
  const auto first = std::ranges::lower_bound(furthest_, wide.min().x()) - furthest_.begin();
  for (auto k = static_cast<std::size_t>(first); k < bodies_.size(); ++k) {
    if (boxes_[k].min().x() > wide.max().x()) break;
    if (wide.intersects(boxes_[k])) candidates.push_back(bodies_[k]);
  }
  std::ranges::sort(candidates);
}

void RestingBodies::keep_near(std::span<const Vec3> points, Real distance,
                              std::vector<Index>& candidates) const {
  Box around;
  for (const Index body : candidates) around.extend(grown(box(body), distance));
  auto left = candidates.begin();  // candidates before it have been found
  const auto look_from = [&](const Vec3& p) {
    particles_.grid.for_each_run(p, distance, [&](Index begin, Index end) {
      for (Index slot = begin; slot < end; ++slot) {
        const Vec3 x(p.x() - particles_.x[slot], p.y() - particles_.y[slot],
                     p.z() - particles_.z[slot]);
        if (!(x.squaredNorm() < distance * distance)) continue;
        const auto found = std::find(left, candidates.end(), particles_.body[slot]);
        if (found != candidates.end()) std::iter_swap(left++, found);
      }
    });
  };
  for (const Vec3& point : points) {
    if (left == candidates.end()) break;
    if (!around.contains(point)) continue;
    const Vec3 p = periodic_.wrap(point);
    periodic_.for_each_image(p, distance, [&](const Vec3& shift) { look_from(p + shift); });
  }
  candidates.erase(left, candidates.end());
  std::ranges::sort(candidates);
}

}  // namespace vat
