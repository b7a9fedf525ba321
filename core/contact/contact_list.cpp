#include "core/contact/contact_list.h"

#include <algorithm>
#include <utility>

#include "core/liquid/pairs/scratch.h"
#include "core/stage/context.h"
#include "core/support/check.h"

namespace vat {
namespace {

/// The skin in reaches, in addition to the slack. A thicker skin lasts longer and has more pairs.
constexpr Real kSkinShare = 0.5;

/// The first particle that has contacts: coupled liquids have none.
Index first_of(const Model& model) {
  return model.is_coupled ? model.liquid_count : 0;
}

}  // namespace

bool ContactList::is_between_current(const StepContext& c, Real slack) {
  if (!(slack < skin_)) return false;
  const std::vector<Vec3>& position = c.configuration.position;
  const Index first = first_of(c.model);
  const std::size_t count = c.model.particle_count - first;
  farthest_.resize(block_count(count));
  for_blocks(c.runner, count, [&](std::size_t begin, std::size_t end) {
    Real farthest = 0;
    for (std::size_t k = begin; k < end; ++k) {
      const Vec3 way = position[first + k] - built_at_[first + k];
      const Real way2 =
          c.model.periodic.any() ? c.model.periodic.nearest(way).squaredNorm() : way.squaredNorm();
      if (!(way2 <= farthest)) farthest = way2;  // also accepts a NaN
    }
    farthest_[begin / kBlockSize] = farthest;
  });
  const Real allowed = (skin_ - slack) / 2;
  return std::ranges::all_of(farthest_, [&](Real way2) { return way2 <= allowed * allowed; });
}

bool ContactList::is_current(const StepContext& c, Real slack) {
  return is_between_current(c, slack) && std::ranges::all_of(within_, [&](SelfContactList& list) {
           return list.is_current(c, slack);
         });
}

std::size_t ContactList::size() const {
  std::size_t size = between_.size();
  for (const SelfContactList& list : within_) size += list.size();
  return size;
}

void ContactList::make_own_lists(const Model& model) {
  std::vector<Index> own_list(model.bodies.size(), kNoList);
  within_.clear();
  const bool has_any = model.has_self_contact && !model.periodic.any();
  for (std::size_t b = 0; has_any && b < model.bodies.size(); ++b) {
    const ModelBody& body = model.bodies[b];
    if (body.kind != BodyKind::deformable || !model.self_contacts[body.material]) continue;
    own_list[b] = static_cast<Index>(within_.size());
    within_.emplace_back(body.particles);
  }
  own_list_ = std::move(own_list);  // all lists exist: there was sufficient memory
}

void ContactList::update(StepContext& c, Real slack) {
  if (own_list_.empty()) make_own_lists(c.model);
  VAT_CHECK(!(slack < 0) && c.configuration.position.size() == c.model.particle_count);
  const bool were_listed = std::exchange(are_listed_, false);
  bool has_searched = false;
  for (SelfContactList& list : within_) has_searched |= list.update(c, slack);
  if (!is_between_current(c, slack)) {
    has_searched = true;
    const Real skin = slack + kSkinShare * c.model.contact_reach;
    skin_ = 0;  // until the list is complete: memory may be insufficient
    search_between(c, skin);
    skin_ = skin;
  }
  if (has_searched || !were_listed) list_particles(c);
  are_listed_ = true;
}

void ContactList::find_candidates(const StepContext& c, Real skin) {
  const Model& model = c.model;
  const std::vector<Vec3>& position = c.configuration.position;
  const bool takes_all = model.periodic.any();
  if (!takes_all) boxes_.build(model, position, model.contact_reach + skin, c.runner);
  is_candidate_.resize(model.particle_count);
  for_blocks(c.runner, model.particle_count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      is_candidate_[i] = takes_all || boxes_.is_near_another(model.body[i], position[i]) ? 1 : 0;
    }
  });
  candidates_.clear();
  for (Index i = model.liquid_count; i < model.particle_count; ++i) {
    if (is_candidate_[i] != 0) candidates_.push_back(i);
  }
}

void ContactList::find_between(const StepContext& c, Index i, Real skin,
                               std::vector<Index>& found) const {
  LiquidScratch& buffers = c.work.of<LiquidScratch>();
  const Model& model = c.model;
  if (i < first_of(model) || is_candidate_[i] == 0) return;
  const ContactSearch search(model, c.configuration, i, skin);
  const auto take = [&](Index j) { found.push_back(j); };
  const Index body = model.body[i];
  const bool takes_own = within_.empty() && model.has_self_contact;
  search.look_in(
      solids_, [&](Index slot) { return solids_.body[slot] != body || takes_own; },
      [&](Index slot) { return solids_.particle[slot]; }, take);
  if (model.is_coupled || (i < model.liquid_count && !model.liquids_touch)) return;
  const std::span<const Index> liquids = buffers.liquid.grid.order();
  search.look_in(
      buffers.liquid,
      [&](Index slot) {
        return i >= model.liquid_count || model.material[liquids[slot]] != model.material[i];
      },
      [&](Index slot) { return liquids[slot]; }, take);
}

void ContactList::search_between(StepContext& c, Real skin) {
  built_at_ = c.configuration.position;
  find_candidates(c, skin);
  solids_.build(c.model, c.configuration.position, candidates_, c.model.contact_reach + skin);
  between_.fill(c.runner, c.model.particle_count,
                [&](Index i, std::vector<Index>& found) { find_between(c, i, skin, found); });
}

void ContactList::list_particles(const StepContext& c) {
  particles_.resize(block_count(c.model.particle_count));
  for_blocks(c.runner, c.model.particle_count, [&](std::size_t begin, std::size_t end) {
    std::vector<Index>& particles = particles_[begin / kBlockSize];
    particles.clear();
    for (std::size_t k = begin; k < end; ++k) {
      const auto i = static_cast<Index>(k);
      if (!between_.of(i).empty() || !within(c.model, i).empty()) particles.push_back(i);
    }
  });
}

}  // namespace vat
