#include "server/relay/relay_feed.h"

#include <exception>
#include <mutex>
#include <span>
#include <stdexcept>
#include <utility>

#include "core/support/check.h"
#include "server/relay/frame_state.h"
#include "server/support/log.h"

namespace vat {
namespace {

/// The owner answers a message of each look().
constexpr std::chrono::seconds kFeedSilence(3);

/// Reduces `errors`, so that they also satisfy `wish`. 0: the attribute is not wanted.
void add_wish(const ByAttribute<double>& wish, ByAttribute<double>& errors) {
  for (std::size_t a = 0; a < kFrameAttributes; ++a) {
    if (wish[a] > 0 && (errors[a] == 0 || wish[a] < errors[a])) errors[a] = wish[a];
  }
}

}  // namespace

RelayFeed::RelayFeed(Place place, NatsConnection& connection, ServerMetrics& metrics,
                     boost::asio::thread_pool& pool, const Clock& clock)
    : place_(std::move(place)),
      connection_(connection),
      clock_(clock),
      frames_(std::make_shared<FrameFeed>(place_.session, std::nullopt, metrics, pool, clock)) {
  const std::lock_guard lock(mutex_);
  open_line();
}

RelayFeed::~RelayFeed() {
  if (is_watching_) line_->send(RelayKind::end);
}

void RelayFeed::open_line() {
  VAT_CHECK(mutex_.is_held());
  if (is_watching_) line_->send(RelayKind::end);
  line_ = std::make_unique<RelayLine>(connection_, place_.owner_subject,
                                      place_.link + "." + std::to_string(++lines_));
  received_ = {};
  decoder_ = {};
  last_ = nullptr;
  is_watching_ = false;
  is_broken_ = false;
  heard_ = clock_.now();
}

std::uint64_t RelayFeed::tick() const {
  const std::lock_guard lock(mutex_);
  return last_ == nullptr ? 0 : last_->header.tick;
}

void RelayFeed::add(std::shared_ptr<ClientOutbox> outbox, std::uint64_t subscription,
                    const Subscription& wanted) {
  const std::lock_guard lock(mutex_);
  VAT_CHECK(outbox != nullptr);
  const ConnectionId id = outbox->id();
  viewers_[id] = {std::move(outbox), subscription, wanted};
  update_watch();
  admit_waiting();
}

void RelayFeed::remove(ConnectionId viewer) {
  const std::lock_guard lock(mutex_);
  if (viewers_.erase(viewer) == 0) return;
  frames_->remove(viewer);
  update_watch();
}

void RelayFeed::repeat(ConnectionId viewer) {
  const std::lock_guard lock(mutex_);
  const auto found = viewers_.find(viewer);
  if (found == viewers_.end()) return;
  found->second.is_waiting = true;
  admit_waiting();
}

void RelayFeed::update_watch() {
  VAT_CHECK(mutex_.is_held());
  ByAttribute<double> wanted{};
  for (const auto& [id, viewer] : viewers_) add_wish(viewer.wanted.attribute_errors, wanted);
  if (std::exchange(is_watching_, true) && wanted == watched_) return;
  watched_ = wanted;
  line_->send(
      RelayKind::watch,
      {{"session", place_.session}, {"subject", place_.own_subject}, {"attributes", wanted}});
}

bool RelayFeed::has_attributes_of(const Subscription& wanted) const {
  VAT_CHECK(mutex_.is_held());
  if (last_ == nullptr) return false;
  for (std::size_t a = 0; a < kFrameAttributes; ++a) {
    if (wanted.attribute_errors[a] > 0 && !(last_->scale.attribute_quanta[a] > 0)) return false;
  }
  return true;
}

void RelayFeed::admit_waiting() {
  VAT_CHECK(mutex_.is_held());
  bool has_new = false;
  for (auto& [id, viewer] : viewers_) {
    if (!viewer.is_waiting || !has_attributes_of(viewer.wanted)) continue;
    viewer.is_waiting = false;
    frames_->add(viewer.outbox, viewer.subscription, viewer.wanted);
    has_new = true;
  }
  if (has_new) publish();
}

void RelayFeed::publish() {
  VAT_CHECK(mutex_.is_held() && last_ != nullptr);
  read_frame_state(*last_, state_);
  frames_->publish(state_);
}

void RelayFeed::receive(const std::string& bytes) {
  auto message = read_relay_message(bytes);
  const std::lock_guard lock(mutex_);
  if (!message || is_broken_ || message->link != line_->link()) return;
  heard_ = clock_.now();
  try {
    const RelayInput::Taken taken = received_.take(*message);
    if (taken == RelayInput::Taken::part) return;
    if (taken == RelayInput::Taken::lost || message->kind == RelayKind::end) {
      is_broken_ = true;  // look() opens another link
    } else if (message->kind == RelayKind::frame) {
      receive_frame(message->body);
    } else if (message->kind == RelayKind::text) {
      receive_facts(message->body);
    }
  } catch (const std::exception& error) {
    log_warning("relay: frames of the session {}: {}", place_.session, error.what());
    is_broken_ = true;
  }
}

void RelayFeed::receive_facts(const std::string& text) {
  VAT_CHECK(mutex_.is_held());
  const FrameFacts facts = read_frame_facts(Json::parse(text));
  frames_->set_vat(facts.vat);
  frames_->set_default_error(facts.default_error);
}

void RelayFeed::receive_frame(const std::string& bytes) {
  VAT_CHECK(mutex_.is_held());
  const std::span data(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  const auto decoded = decoder_.decode(data);
  if (!decoded) throw std::runtime_error(decoded.errors().front().message);
  last_ = decoded.value();
  line_->send(RelayKind::ack, {{"number", last_->header.number}});
  publish();
  admit_waiting();
}

void RelayFeed::look(std::chrono::seconds patience) {
  const std::lock_guard lock(mutex_);
  const auto now = clock_.now();
  for (const auto& [id, viewer] : viewers_) viewer.outbox->close_if_silent(now, patience);
  if (!is_watching_ || viewers_.empty()) return;
  if (is_broken_ || now - heard_ > kFeedSilence) {
    open_line();
    return update_watch();
  }
  line_->send(RelayKind::alive, {{"subject", place_.own_subject}});
}

}  // namespace vat
