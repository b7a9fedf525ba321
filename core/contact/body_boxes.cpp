#include "core/contact/body_boxes.h"

#include <algorithm>

#include "core/support/check.h"

namespace vat {

void BodyBoxes::build(const Model& model, const std::vector<Vec3>& positions, Real reach,
                      TaskRunner* runner) {
  VAT_CHECK(reach >= 0 && positions.size() == model.particle_count);
  const std::vector<ModelBody>& bodies = model.bodies;
  boxes_.resize(bodies.size());
  wide_.resize(bodies.size());
  for_blocks<1>(runner, bodies.size(), [&](std::size_t b, std::size_t) {
    Box& box = boxes_[b];
    box.setEmpty();
    if (model.is_coupled && bodies[b].kind == BodyKind::liquid) return;
    for (Index i = bodies[b].particles.begin; i < bodies[b].particles.end; ++i) {
      box.extend(positions[i]);
    }
    wide_[b] = {box.min().array() - reach, box.max().array() + reach};
  });
  find_pairs();
}

int BodyBoxes::longest_axis() const {
  Vec3 sum = Vec3::Zero();
  Vec3 squares = Vec3::Zero();
  for (const Index b : by_left_) {
    const Vec3 center = boxes_[b].center();
    sum += center;
    squares += center.cwiseAbs2();
  }
  const Vec3 spread =
      squares - sum.cwiseAbs2() / static_cast<Real>(std::max<std::size_t>(1, by_left_.size()));
  int axis = 0;
  spread.maxCoeff(&axis);
  return axis;
}

// Sweeps along the axis with the largest variance of the boxes, so that few overlap along it.
void BodyBoxes::find_pairs() {
  by_left_.clear();
  for (Index b = 0; b < boxes_.size(); ++b) {
    // Omits empty boxes and boxes with a NaN.
    if ((boxes_[b].min().array() <= boxes_[b].max().array()).all()) by_left_.push_back(b);
  }
  const int axis = longest_axis();
  std::ranges::sort(by_left_, {}, [&](Index b) { return boxes_[b].min()[axis]; });
  pairs_.clear();
  for (std::size_t k = 0; k < by_left_.size(); ++k) {
    const Box& box = wide_[by_left_[k]];
    for (std::size_t l = k + 1; l < by_left_.size(); ++l) {
      const Box& other = boxes_[by_left_[l]];
      if (other.min()[axis] > box.max()[axis]) break;
      if (box.intersects(other)) pairs_.emplace_back(by_left_[k], by_left_[l]);
    }
  }

  near_begin_.assign(boxes_.size() + 1, 0);
  for (const auto& [a, b] : pairs_) {
    ++near_begin_[a];
    ++near_begin_[b];
  }
  Index end = 0;
  for (Index& begin : near_begin_) begin = end += begin;
  near_.resize(end);
  for (const auto& [a, b] : pairs_) {  // from their ends down to their beginnings
    near_[--near_begin_[a]] = b;
    near_[--near_begin_[b]] = a;
  }
}

bool BodyBoxes::is_near_another(Index body, const Vec3& p) const {
  return std::ranges::any_of(near(body), [&](Index other) { return wide_[other].contains(p); });
}

}  // namespace vat
