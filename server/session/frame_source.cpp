#include "server/session/frame_source.h"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

namespace vat {
namespace {

/// Where anything has moved, mostly the first particle has.
bool shows_the_same(const PublishedState& a, const PublishedState& b) {
  return a.header.epoch == b.header.epoch && a.header.playing == b.header.playing &&
         a.header.slow == b.header.slow && a.has_vat == b.has_vat && a.vat_offset == b.vat_offset &&
         a.bodies == b.bodies;
}

}  // namespace

FrameSource::FrameSource(const std::optional<Vat>& vat, ServerMetrics& metrics)
    : metrics_(metrics), domain_(vat) {}

void FrameSource::set_vat(const std::optional<Vat>& vat) {
  domain_ = FrameDomain(vat);
}

void FrameSource::publish(PublishedState state, std::size_t watchers) {
  if (publication_ == 0 || !shows_the_same(state, state_)) ++places_;
  ++publication_;
  state_ = std::move(state);
  domain_.include(state_);
  // Grids that nobody asks for any more go at last; who asks for one again gets one frame more.
  if (encoded_.size() > watchers) encoded_.clear();
}

std::uint64_t FrameSource::content(double max_error) {
  return find(max_error).content;
}

SharedFrame FrameSource::frame(double max_error) {
  Encoded& encoded = find(max_error);
  if (encoded.publication != publication_) encode(encoded);
  return encoded.frame;
}

FrameSource::Encoded& FrameSource::find(double max_error) {
  const FrameGrid grid = domain_.grid(max_error);
  Encoded& encoded = encoded_[grid.quantum];  // the origin is the same for all
  if (encoded.places != places_ || encoded.grid != grid) {
    encoded.grid = grid;
    encode(encoded);
  }
  return encoded;
}

void FrameSource::encode(Encoded& encoded) {
  GridFrame shown;
  make_grid_frame(state_, {encoded.grid, {}}, shown);
  shown.header.number = static_cast<std::uint32_t>(places_);
  if (encoded.frame == nullptr || !show_the_same(encoded.shown, shown)) {
    encoded.content = ++last_content_;
  }
  const auto bytes = encoder_.encode(shown, {});
  encoded.frame = std::make_shared<const std::string>(bytes.begin(), bytes.end());
  encoded.shown = std::move(shown);
  encoded.places = places_;
  encoded.publication = publication_;
  metrics_.add_encoded_frame();
}

}  // namespace vat
