#include "core/step/local_pairs.h"

#include <algorithm>

#include "core/forces/contact_search.h"
#include "core/limits.h"

namespace vat {
namespace {

bool is_moved(const Model& model, Index i) {
  if (i < model.free_count) return model.inverse_mass[i] > 0;
  return model.rigid_bodies[model.bodies[model.body[i]].rigid].inverse_mass > 0;
}

/// From the finest level to the coarsest, and otherwise as they are; few and nearly in order.
void sort_by_level(std::span<LocalPair> pairs) {
  for (std::size_t k = 1; k < pairs.size(); ++k) {
    const LocalPair pair = pairs[k];
    std::size_t place = k;
    for (; place > 0 && pairs[place - 1].level < pair.level; --place) {
      pairs[place] = pairs[place - 1];
    }
    pairs[place] = pair;
  }
}

}  // namespace

void LocalPairs::collect(const ForceModel& f, const Configuration& at, const LocalLevels& levels,
                         Index i, std::vector<LocalPair>& pairs) {
  const Model& model = f.model;
  const auto level_with = [&](Index j) { return std::max(levels.particle[i], levels.particle[j]); };
  if (i >= model.liquid_count && i < model.free_count) {
    for (Index s = model.spring_begin[i]; s < model.spring_begin[i + 1]; ++s) {
      const SpringEnd& spring = model.spring_ends[s];
      pairs.push_back({spring.other, level_with(spring.other), false, spring.stiffness,
                       spring.damping, spring.rest_length, Vec3::Zero()});
    }
  }
  if (model.contact_reach <= 0) return;
  for_each_contact(
      model, f.work, at, i,
      [&](const Contact& contact) {
        const Index j = contact.other;
        Vec3 shift = Vec3::Zero();
        if (model.periodic.any()) shift = contact.x - (at.position[i] - at.position[j]);
        pairs.push_back(
            {j, level_with(j), true, contact.stiffness, contact.damping, contact.threshold, shift});
      },
      skin_);
}

void LocalPairs::build(const ForceModel& f, const Configuration& at, const LocalLevels& levels) {
  const Model& model = f.model;
  skin_ = levels.skin;
  built_at_ = at.position;
  blocks_.resize((model.particle_count + kBlockSize - 1) / kBlockSize);
  finest_of_.resize(model.particle_count);
  for_blocks(f.runner, model.particle_count, [&](std::size_t begin, std::size_t end) {
    Block& block = blocks_[begin / kBlockSize];
    block.pairs.clear();
    for (std::size_t k = begin; k < end; ++k) {
      const auto i = static_cast<Index>(k);
      const std::size_t first = block.pairs.size();
      block.begin[k - begin] = first;
      finest_of_[i] = -1;
      if (!is_moved(model, i)) continue;
      collect(f, at, levels, i, block.pairs);
      sort_by_level(std::span(block.pairs).subspan(first));
      finest_of_[i] = levels.particle[i];
      if (block.pairs.size() > first) {
        finest_of_[i] = std::max<int>(finest_of_[i], block.pairs[first].level);
      }
    }
    block.begin[end - begin] = block.pairs.size();
  });
  sort_particles(model, levels);
}

void LocalPairs::sort_particles(const Model& model, const LocalLevels& levels) {
  due_count_.assign(kMaxStepLevel + 1, 0);
  order_.clear();
  finest_rigid_ = -1;
  for (int level = kMaxStepLevel; level >= 0; --level) {
    for (Index i = 0; i < model.particle_count; ++i) {
      if (finest_of_[i] == level) order_.push_back(i);
    }
    due_count_[static_cast<std::size_t>(level)] = order_.size();
  }
  finest_ = levels.liquid;
  coarsest_ = order_.empty() ? 0 : kMaxStepLevel;
  for (const Index i : order_) coarsest_ = std::min<int>(coarsest_, levels.particle[i]);
  for (Index i = 0; i < model.particle_count; ++i) {
    finest_ = std::max(finest_, finest_of_[i]);
    if (i >= model.free_count) finest_rigid_ = std::max(finest_rigid_, finest_of_[i]);
  }
}

bool LocalPairs::is_stale(const ForceModel& f, const Configuration& at) {
  if (f.model.contact_reach <= 0) return false;
  farthest_.resize(blocks_.size());
  for_blocks(f.runner, f.model.particle_count, [&](std::size_t begin, std::size_t end) {
    Real farthest = 0;
    for (std::size_t i = begin; i < end; ++i) {
      farthest = std::max(farthest, (at.position[i] - built_at_[i]).squaredNorm());
    }
    farthest_[begin / kBlockSize] = farthest;
  });
  return std::ranges::any_of(farthest_,
                             [&](Real moved2) { return !(4 * moved2 <= skin_ * skin_); });
}

}  // namespace vat
