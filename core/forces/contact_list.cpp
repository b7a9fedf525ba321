#include "core/forces/contact_list.h"

#include <algorithm>
#include <numeric>

#include "core/forces/contact_search.h"
#include "core/forces/contacts.h"
#include "core/step/workspace.h"

namespace vat {
namespace {

/// Of the reach, beyond what was asked for: a thicker skin lasts longer and has more pairs in it.
constexpr Real kSkinShare = 0.5;

}  // namespace

bool ContactList::is_current(const StepContext& c, Real slack) {
  if (!(slack < skin_)) return false;
  const std::vector<Vec3>& position = c.configuration.position;
  farthest_.resize(blocks_.size());
  for_blocks(c.runner, c.model.particle_count, [&](std::size_t begin, std::size_t end) {
    Real farthest = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3 way = position[i] - built_at_[i];
      const Real way2 =
          c.model.periodic.any() ? c.model.periodic.nearest(way).squaredNorm() : way.squaredNorm();
      if (!(way2 <= farthest)) farthest = way2;  // takes what is not a number
    }
    farthest_[begin / kBlockSize] = farthest;
  });
  const Real allowed = (skin_ - slack) / 2;
  return std::ranges::all_of(farthest_, [&](Real way2) { return way2 <= allowed * allowed; });
}

std::size_t ContactList::size() const {
  std::size_t size = 0;
  for (const Block& block : blocks_) size += block.others.size();
  return size;
}

void ContactList::update(StepContext& c, Real slack) {
  if (is_current(c, slack)) return;
  const Real skin = slack + kSkinShare * c.model.contact_reach;
  skin_ = 0;  // until the list is whole: there may be no memory for it
  sort_solids(c, skin);
  search(c, skin);
  skin_ = skin;
}

void ContactList::find_near_bodies(const StepContext& c, Real skin) {
  const std::vector<ModelBody>& bodies = c.model.bodies;
  boxes_.assign(bodies.size(), {});
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    for (Index i = bodies[b].particles.begin; i < bodies[b].particles.end; ++i) {
      boxes_[b].extend(c.configuration.position[i]);
    }
  }
  const Real reach = c.model.contact_reach + skin;
  for (Box& box : boxes_) {
    box.min().array() -= reach;
    box.max().array() += reach;
  }
  by_left_.resize(bodies.size());
  std::iota(by_left_.begin(), by_left_.end(), Index{0});
  std::ranges::sort(by_left_, {}, [&](Index b) { return boxes_[b].min().x(); });
  near_.resize(bodies.size());
  for (std::vector<Index>& near : near_) near.clear();
  for (std::size_t k = 0; k < by_left_.size(); ++k) {
    const Index b = by_left_[k];
    for (std::size_t l = k + 1; l < by_left_.size(); ++l) {
      const Index other = by_left_[l];
      if (boxes_[other].min().x() > boxes_[b].max().x()) break;
      if (!boxes_[b].intersects(boxes_[other])) continue;
      near_[b].push_back(other);
      near_[other].push_back(b);
    }
  }
}

bool ContactList::may_touch(const StepContext& c, Index i) const {
  if (c.model.periodic.any()) return true;
  const ModelBody& body = c.model.bodies[c.model.body[i]];
  if (body.kind == BodyKind::deformable && c.model.self_contacts[body.material]) return true;
  return std::ranges::any_of(near_[c.model.body[i]], [&](Index other) {
    return boxes_[other].contains(c.configuration.position[i]);
  });
}

void ContactList::search(StepContext& c, Real skin) {
  built_at_ = c.configuration.position;
  find_near_bodies(c, skin);
  blocks_.resize(block_count(c.model.particle_count));
  for_blocks(c.runner, c.model.particle_count, [&](std::size_t begin, std::size_t end) {
    Block& block = blocks_[begin / kBlockSize];
    block.others.clear();
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t first = block.others.size();
      block.begin[i - begin] = first;
      if (!may_touch(c, static_cast<Index>(i))) continue;
      for_each_contact(
          c.model, c.work, c.configuration, static_cast<Index>(i),
          [&](const Contact& contact) { block.others.push_back(contact.other); }, skin);
      const auto begin_of_i = block.others.begin() + static_cast<std::ptrdiff_t>(first);
      std::sort(begin_of_i, block.others.end());
      block.others.erase(std::unique(begin_of_i, block.others.end()), block.others.end());
    }
    block.begin[end - begin] = block.others.size();
  });
}

}  // namespace vat
