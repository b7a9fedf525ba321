#include "server/frames/frame_source.h"

#include <algorithm>
#include "core/support/check.h"

namespace vat {
namespace {

/// Differences are usually found at the first particle.
bool shows_the_same(const PublishedState& a, const PublishedState& b) {
  return a.header.epoch == b.header.epoch && a.header.playing == b.header.playing &&
         a.header.slow == b.header.slow && a.has_vat == b.has_vat && a.vat_offset == b.vat_offset &&
         a.bodies == b.bodies;
}

}  // namespace

FrameCut::FrameCut(const Subscription& subscription, double default_error, unsigned coarseness,
                   std::uint8_t detail)
    : max_error_(subscription.max_error.value_or(default_error)),
      coarseness_(coarseness),
      attribute_errors_(subscription.attribute_errors),
      detail_(std::min(subscription.selection.detail, detail)),
      has_region_(subscription.selection.region.has_value()) {
  VAT_CHECK(max_error_ >= 0 && coarseness_ > 0);
  if (!has_region_) return;
  const auto& [min, max] = *subscription.selection.region;
  region_ = {min.x(), min.y(), min.z(), max.x(), max.y(), max.z()};
}

FrameSelection FrameCut::selection() const {
  FrameSelection selection;
  selection.detail = detail_;
  if (has_region_) {
    selection.region =
        FrameRegion{{region_[0], region_[1], region_[2]}, {region_[3], region_[4], region_[5]}};
  }
  return selection;
}

FrameCut FrameCut::of_all() const {
  FrameCut all = *this;
  all.detail_ = kFullDetail;
  all.has_region_ = false;
  all.region_ = {};
  return all;
}

FrameSource::FrameSource(const std::optional<Vat>& vat, ServerMetrics& metrics)
    : metrics_(metrics), domain_(vat) {}

void FrameSource::set_vat(const std::optional<Vat>& vat) {
  domain_ = FrameDomain(vat);
}

void FrameSource::publish(PublishedState& state) {
  const std::uint32_t number = state_.header.number;
  const bool shows_more = number == 0 || !shows_the_same(state, state_);
  std::swap(state_, state);
  state_.header.number = shows_more ? number + 1 : number;
  domain_.include(state_);
  frames_.clear();
}

FrameScale FrameSource::scale(const FrameCut& cut) const {
  FrameScale scale;
  scale.grid = domain_.grid(cut.max_error());
  VAT_CHECK(scale.grid.quantum > 0);
  // The finest grid, whose quantum is below the requested error, is coarsened too.
  if (cut.coarseness() > 1) scale.grid = domain_.grid(cut.coarseness() * scale.grid.quantum / 2);
  for (std::size_t a = 0; a < kFrameAttributes; ++a) {
    scale.attribute_quanta[a] = 2 * cut.coarseness() * cut.attribute_errors()[a];
  }
  return scale;
}

std::shared_ptr<const GridFrame> FrameSource::frame(const FrameCut& cut) {
  std::shared_ptr<const GridFrame>& known = frames_[cut];
  if (known != nullptr) return known;
  const std::shared_ptr<GridFrame> quantised = pool_.take();
  VAT_CHECK(quantised != nullptr);
  const FrameSelection selection = cut.selection();
  if (selection.region) {
    select_particles(*frame(cut.of_all()), selection, *quantised);
  } else {
    make_grid_frame(state_, scale(cut), selection.detail, *quantised);
  }
  return frames_[cut] = quantised;
}

SharedFrame FrameSource::encode(const GridFrame& frame, const HeldFrames& held,
                                std::uint8_t stride) {
  const auto begin = CostClock::now();
  FrameReferences references;
  if (held[0] != nullptr && can_refer(frame, *held[0])) {
    references.first = held[0].get();
    if (held[1] != nullptr && can_refer(*held[0], *held[1])) references.second = held[1].get();
  }
  const auto bytes = encoder_.encode(frame, references, stride);
  VAT_CHECK(!bytes.empty());
  auto shared = std::make_shared<const std::string>(bytes.begin(), bytes.end());
  metrics_.add_encoded_frame(CostClock::now() - begin, references.first == nullptr);
  return shared;
}

}  // namespace vat
