#include "core/stepping/local_pairs.h"
#include "core/contact/scratch.h"

#include <algorithm>

#include "core/limits.h"
#include "core/solid/spring_changes.h"
#include "core/support/check.h"

namespace vat {
namespace {

bool is_moved(const Model& model, Index i) {
  if (i < model.free_count) return model.inverse_mass[i] > 0;
  const RigidModel& rigid = model.rigid_bodies[model.bodies[model.body[i]].rigid];
  return rigid.inverse_mass > 0 || rigid.axle;
}

/// Sorts from the finest level to the coarsest, keeping the order of equal levels. There are few
/// pairs, nearly in order.
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

template <class Collect>
void LocalPairs::fill(const ForceModel& f, std::vector<Block>& blocks, Collect&& collect) {
  const Model& model = f.model;
  blocks.resize(block_count(model.particle_count));
  for_blocks(f.runner, model.particle_count, [&](std::size_t begin, std::size_t end) {
    Block& block = blocks[begin / kBlockSize];
    block.pairs.clear();
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t first = block.pairs.size();
      block.begin[k - begin] = first;
      if (!is_moved(model, static_cast<Index>(k))) continue;
      collect(static_cast<Index>(k), block.pairs);
      sort_by_level(std::span(block.pairs).subspan(first));
    }
    block.begin[end - begin] = block.pairs.size();
  });
}

void LocalPairs::build_springs(const ForceModel& f, const Configuration& at,
                               const LocalLevels& levels) {
  const Model& model = f.model;
  fill(f, springs_, [&](Index i, std::vector<LocalPair>& pairs) {
    if (i < model.liquid_count || i >= model.free_count) return;
    for (Index s = model.spring_begin[i]; s < model.spring_begin[i + 1]; ++s) {
      const SpringEnd spring = present_spring(model, at, s);
      const std::uint8_t level = std::max(levels.particle[i], levels.particle[spring.other]);
      pairs.push_back(
          {spring.other, level, false, spring.stiffness, spring.damping, spring.rest_length, 0});
    }
  });
  spring_levels_ = levels.particle;
}

void LocalPairs::build_contacts(const ForceModel& f, const Configuration& at,
                                const LocalLevels& levels) {
  const Model& model = f.model;
  fill(f, contacts_, [&](Index i, std::vector<LocalPair>& pairs) {
    if (model.contact_reach <= 0) return;
    f.work.of<ContactForceScratch>().contacts.for_each(
        model, at, i,
        [&](const Contact& contact) {
          const std::uint8_t level = std::max(levels.particle[i], levels.particle[contact.other]);
          pairs.push_back({contact.other, level, true, contact.stiffness, contact.damping,
                           contact.threshold, contact.layer});
        },
        skin_);
  });
}

void LocalPairs::build(const ForceModel& f, const Configuration& at, const LocalLevels& levels,
                       bool model_changed) {
  skin_ = levels.skin;
  VAT_CHECK(levels.particle.size() == f.model.particle_count);
  const bool same_levels = !model_changed && levels.particle == spring_levels_;
  if (!same_levels) build_springs(f, at, levels);
  if (same_levels && f.model.contact_reach <= 0) return;
  built_at_ = at.position;
  build_contacts(f, at, levels);
  sort_particles(f.model, levels);
}

/// Counting sort: from the finest level to the coarsest, and by index within a level.
void LocalPairs::sort_particles(const Model& model, const LocalLevels& levels) {
  finest_of_.resize(model.particle_count);
  std::array<std::size_t, kMaxStepLevel + 2>
      count{};  // of the levels, and of particles that do not move
  finest_ = 0;
  coarsest_ = kMaxStepLevel;
  finest_rigid_ = -1;
  for (Index i = 0; i < model.particle_count; ++i) {
    int finest = -1;
    if (is_moved(model, i)) {
      finest = levels.particle[i];
      for (const std::vector<Block>* blocks : {&springs_, &contacts_}) {
        const Block& block = (*blocks)[i / kBlockSize];
        const std::size_t first = block.begin[i % kBlockSize];
        if (first == block.begin[i % kBlockSize + 1]) continue;
        finest = std::max<int>(finest, block.pairs[first].level);
      }
      coarsest_ = std::min<int>(coarsest_, levels.particle[i]);
    }
    finest_of_[i] = finest;
    finest_ = std::max(finest_, finest);
    if (i >= model.free_count) finest_rigid_ = std::max(finest_rigid_, finest);
    VAT_CHECK(finest <= kMaxStepLevel);
    ++count[static_cast<std::size_t>(kMaxStepLevel - finest)];
  }
  coarsest_ = std::min(coarsest_, finest_);
  finest_ = std::max<int>(finest_, levels.liquid);

  due_count_.resize(kMaxStepLevel + 1);
  std::array<std::size_t, kMaxStepLevel + 2> next{};
  for (std::size_t k = 0; k <= kMaxStepLevel; ++k) {
    next[k + 1] = next[k] + count[k];
    due_count_[kMaxStepLevel - k] = next[k + 1];
  }
  order_.resize(due_count_[0]);
  for (Index i = 0; i < model.particle_count; ++i) {
    if (finest_of_[i] < 0) continue;
    order_[next[static_cast<std::size_t>(kMaxStepLevel - finest_of_[i])]++] = i;
  }
}

bool LocalPairs::is_stale(const ForceModel& f, const Configuration& at) {
  if (f.model.contact_reach <= 0) return false;
  VAT_CHECK(built_at_.size() == at.position.size());
  farthest_.resize(contacts_.size());
  const Index first = f.model.is_coupled ? f.model.liquid_count : 0;  // others have no connections
  for_blocks(f.runner, f.model.particle_count, [&](std::size_t begin, std::size_t end) {
    Real farthest = 0;
    for (std::size_t i = begin; i < end; ++i) {
      if (i < first) continue;
      farthest = std::max(farthest, (at.position[i] - built_at_[i]).squaredNorm());
    }
    farthest_[begin / kBlockSize] = farthest;
  });
  return std::ranges::any_of(farthest_,
                             [&](Real moved2) { return !(4 * moved2 <= skin_ * skin_); });
}

}  // namespace vat
