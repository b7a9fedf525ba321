#include "server/frames/frame_delivery.h"

#include <algorithm>
#include <utility>

#include "core/support/check.h"
#include "server/frames/frame_groups.h"
#include "server/messages/limits.h"

namespace vat {
namespace {

/// Periods after which a viewer's references are dropped, and it receives a key frame.
constexpr std::uint64_t kMaxTurnsHeld = 16;

/// Ensures that even the slowest viewer receives one frame in a hundred ticks.
unsigned most_stride(std::uint64_t every) {
  return static_cast<unsigned>(std::clamp<std::uint64_t>(kMaxFrameInterval / every, 1, 4));
}

/// Number of particles that a level of detail can omit.
std::size_t particle_count(const PublishedState& state) {
  std::size_t count = 0;
  for (const PublishedState::Body& body : state.bodies) count += body.positions.size();
  return count;
}

}  // namespace

FrameDelivery::FrameDelivery(const std::optional<Vat>& vat, ServerMetrics& metrics)
    : metrics_(metrics), source_(vat, metrics) {}

void FrameDelivery::add(std::shared_ptr<ClientOutbox> outbox, std::uint64_t subscription,
                        Subscription subscribed) {
  const ConnectionId client = outbox->id();
  VAT_CHECK(subscribed.every > 0);
  Viewer viewer;
  viewer.outbox = std::move(outbox);
  viewer.subscription = subscription;
  viewer.pace = FramePace(most_stride(subscribed.every));
  viewer.subscribed = std::move(subscribed);
  viewers_[client] = std::move(viewer);
}

void FrameDelivery::remove(ConnectionId client) {
  viewers_.erase(client);
  if (viewers_.empty()) has_state_ = false;  // it would be old when the next viewer comes
}

void FrameDelivery::restart(ConnectionId client, std::uint32_t number) {
  const auto found = viewers_.find(client);
  if (found == viewers_.end() || number < found->second.key_number) return;
  Viewer& viewer = found->second;
  viewer.held = {};
  viewer.awaits_any = viewer.owes_frame = true;
}

void FrameDelivery::set_vat(const std::optional<Vat>& vat) {
  source_.set_vat(vat);
  has_state_ = false;
}

void FrameDelivery::publish(PublishedState& state, SteadyClock::time_point now) {
  encoded_.clear();
  rest_.clear();
  note_turns(state);
  least_detail_ = least_detail(particle_count(state));
  source_.publish(state);
  Groups groups;
  for (auto& [client, viewer] : viewers_) {
    gather(viewer, now, groups);
    viewer.has_turn = false;
  }
  serve(groups, now);
  metrics_.add_frame_groups(encoded_.size());
}

void FrameDelivery::retry(std::span<const ConnectionId> clients, SteadyClock::time_point now) {
  if (!has_state_) return;
  Groups groups;
  for (const ConnectionId client : clients) {
    const auto viewer = viewers_.find(client);
    if (viewer != viewers_.end()) gather(viewer->second, now, groups);
  }
  serve(groups, now);
}

void FrameDelivery::serve_rest(SteadyClock::time_point now) {
  encoded_.clear();
  retry(std::exchange(rest_, {}), now);
}

void FrameDelivery::note_turns(const PublishedState& state) {
  const bool is_new_epoch = !has_state_ || state.header.epoch != epoch_;
  for (auto& [client, viewer] : viewers_) {
    viewer.awaits_any |= is_new_epoch;
    viewer.has_turn = viewer.awaits_any || turn_has_come(viewer, state);
    viewer.owes_frame |= viewer.has_turn;
  }
  has_state_ = true;
  epoch_ = state.header.epoch;
  is_playing_ = state.header.playing;
  tick_ = state.header.tick;
}

/// Whether a multiple of the viewer's period lies after the last state and not after this one, also
/// if its state was not published. Viewers with equal periods are therefore due the same states. A
/// slow viewer that received its last frame late skips one. In a paused session all viewers are due
/// the state, because no newer one may come.
bool FrameDelivery::turn_has_come(const Viewer& viewer, const PublishedState& state) const {
  const std::uint64_t tick = state.header.tick;
  if (!state.header.playing)
    return tick / viewer.subscribed.every > viewer.sent_tick / viewer.subscribed.every;
  const std::uint64_t period = viewer.period();
  if (viewer.pace.stride() > 1 && tick < viewer.sent_tick + period / 2) return false;
  return tick / period > tick_ / period;
}

void FrameDelivery::gather(Viewer& viewer, SteadyClock::time_point now, Groups& groups) {
  if (!viewer.owes_frame) return;
  if (!viewer.awaits_any && viewer.shown == source_.number()) {
    viewer.owes_frame = false;
    return;
  }
  if (source_.number() - viewer.shown > kMaxTurnsHeld * viewer.period()) viewer.held = {};
  const FrameChannel channel = viewer.outbox->frame_channel(viewer.subscription);
  if (!channel.is_open) return;
  viewer.pace.set_least_detail(least_detail_);
  if (viewer.has_turn) viewer.pace.frame_due(channel.is_ready, channel.delays, now);
  if (!channel.is_ready) {
    if (viewer.has_turn) metrics_.add_missed_frames(1);
    return;
  }
  GroupKey key;
  const bool is_exact = viewer.subscribed.keeps_precision;
  key.cut = FrameCut(viewer.subscribed, default_error_, is_exact ? 1 : viewer.pace.coarseness(),
                     is_exact ? kFullDetail : viewer.pace.detail());
  key.stride = static_cast<std::uint8_t>(viewer.period());
  VAT_CHECK(key.stride == viewer.period());
  key.awaits_any = viewer.awaits_any;
  key.first = viewer.held[0].get();
  key.second = viewer.held[1].get();
  groups[key].push_back(&viewer);
}

void FrameDelivery::serve(const Groups& groups, SteadyClock::time_point now) {
  std::vector<GroupClaim> claims;
  std::vector<Groups::const_iterator> entries;
  for (auto group = groups.begin(); group != groups.end(); ++group) {
    const auto& viewers = group->second;
    VAT_CHECK(!viewers.empty());
    const auto longest = std::ranges::max_element(viewers, {}, &Viewer::passed_over);
    claims.push_back({viewers.size(), (*longest)->passed_over});
    entries.push_back(group);
  }
  std::vector<bool> is_served(entries.size());
  for (const std::size_t index : choose_groups(claims, kMaxFrameGroups)) {
    const auto& [key, viewers] = *entries[index];
    VAT_CHECK(!is_served[index]);
    const EncodedFrame* encoded = encode(key, viewers.front()->held);
    if (encoded == nullptr) continue;
    is_served[index] = true;
    std::size_t sent = 0;
    for (Viewer* viewer : viewers) sent += send(*viewer, *encoded, now) ? 1 : 0;
    VAT_CHECK(sent == 0 || encoded->bytes != nullptr);
    if (sent > 0) metrics_.add_sent_frames(sent, encoded->bytes->size());
  }
  for (std::size_t index = 0; index < entries.size(); ++index) {
    if (is_served[index]) continue;
    for (Viewer* viewer : entries[index]->second) {
      ++viewer->passed_over;
      if (!is_playing_) rest_.push_back(viewer->outbox->id());
    }
    metrics_.add_missed_frames(entries[index]->second.size());
  }
}

/// Returns null if kMaxFrameGroups frames of this state are encoded already.
const FrameDelivery::EncodedFrame* FrameDelivery::encode(const GroupKey& key,
                                                         const HeldFrames& held) {
  if (const auto found = encoded_.find(key); found != encoded_.end()) return &found->second;
  if (encoded_.size() >= kMaxFrameGroups) return nullptr;
  EncodedFrame encoded;
  encoded.frame = source_.frame(key.cut);
  if (key.awaits_any || held[0] == nullptr || !show_the_same(*held[0], *encoded.frame)) {
    encoded.bytes = source_.encode(*encoded.frame, held, key.stride);
  }
  return &encoded_.emplace(key, std::move(encoded)).first->second;
}

bool FrameDelivery::send(Viewer& viewer, const EncodedFrame& encoded, SteadyClock::time_point now) {
  viewer.owes_frame = false;
  VAT_CHECK(encoded.frame != nullptr);
  viewer.passed_over = 0;
  viewer.shown = source_.number();
  if (encoded.bytes == nullptr) return false;
  if (!viewer.outbox->send_frame(viewer.subscription, epoch_, encoded.bytes, now)) return false;
  viewer.awaits_any = false;
  viewer.sent_tick = tick_;
  if (viewer.held[0] == nullptr) viewer.key_number = source_.number();
  viewer.held = {encoded.frame, std::exchange(viewer.held[0], nullptr)};
  return true;
}

}  // namespace vat
