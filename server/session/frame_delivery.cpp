#include "server/session/frame_delivery.h"

#include <utility>

namespace vat {
namespace {

/// Whether a tick that `every` divides is the last one or lies after the one before it: states that
/// were never published count too.
bool turn_has_come(std::uint64_t every, std::uint64_t before, std::uint64_t tick) {
  return tick / every > before / every;
}

}  // namespace

FrameDelivery::FrameDelivery(const std::optional<Vat>& vat, ServerMetrics& metrics)
    : source_(vat, metrics) {}

void FrameDelivery::add(std::shared_ptr<ClientOutbox> outbox, std::uint64_t subscription,
                        Subscription wish) {
  const ConnectionId client = outbox->id();
  Viewer viewer;
  viewer.outbox = std::move(outbox);
  viewer.subscription = subscription;
  viewer.wish = wish;
  viewers_[client] = std::move(viewer);
}

void FrameDelivery::remove(ConnectionId client) {
  viewers_.erase(client);
  if (viewers_.empty()) has_state_ = false;  // it would be old when the next viewer comes
}

void FrameDelivery::set_vat(const std::optional<Vat>& vat) {
  source_.set_vat(vat);
  has_state_ = false;
}

void FrameDelivery::publish(PublishedState state) {
  note_turns(state);
  source_.publish(std::move(state), viewers_.size());
  for (auto& [client, viewer] : viewers_) serve(viewer);
}

void FrameDelivery::retry(std::span<const ConnectionId> clients) {
  if (!has_state_) return;
  for (const ConnectionId client : clients) {
    const auto viewer = viewers_.find(client);
    if (viewer != viewers_.end()) serve(viewer->second);
  }
}

void FrameDelivery::note_turns(const PublishedState& state) {
  const bool is_new_epoch = !has_state_ || state.header.epoch != epoch_;
  for (auto& [client, viewer] : viewers_) {
    viewer.awaits_any |= is_new_epoch;
    const bool is_due =
        viewer.awaits_any || turn_has_come(viewer.wish.every, tick_, state.header.tick);
    viewer.is_owed |= is_due;
  }
  has_state_ = true;
  epoch_ = state.header.epoch;
  tick_ = state.header.tick;
}

void FrameDelivery::serve(Viewer& viewer) {
  if (!viewer.is_owed) return;
  const std::uint64_t content = source_.content(viewer.wish.max_error);
  if (!viewer.awaits_any && viewer.shown == content) {
    viewer.is_owed = false;
    return;
  }
  if (!viewer.outbox->ready_for_frame(viewer.subscription)) return;
  viewer.outbox->send_frame(viewer.subscription, epoch_, source_.frame(viewer.wish.max_error));
  viewer.shown = content;
  viewer.awaits_any = viewer.is_owed = false;
}

}  // namespace vat
