#include "server/frames/frame_feed.h"

#include <boost/asio/post.hpp>
#include <exception>
#include <utility>
#include "core/support/check.h"
#include "server/support/log.h"
#include "server/support/low_priority.h"

namespace vat {
namespace {

/// About a tenth of a busy processor: a late encoder drops a frame, but a late tick slows the
/// session down.
constexpr int kNiceness = 10;

}  // namespace

FrameFeed::FrameFeed(std::string session, const std::optional<Vat>& vat, ServerMetrics& metrics,
                     boost::asio::thread_pool& pool, const Clock& clock)
    : session_(std::move(session)),
      clock_(clock),
      strand_(boost::asio::make_strand(pool.get_executor())),
      delivery_(vat, metrics) {}

bool FrameFeed::add(std::shared_ptr<ClientOutbox> outbox, std::uint64_t subscription,
                    Subscription wish) {
  bool has_dropped = false;
  put([&] {
    pending_.changes.emplace_back(Added{std::move(outbox), subscription, wish});
    has_dropped = std::exchange(pending_.has_state, false);
  });
  return has_dropped;
}

void FrameFeed::remove(ConnectionId client) {
  put([&] { pending_.changes.emplace_back(client); });
}

void FrameFeed::set_vat(const std::optional<Vat>& vat) {
  put([&] {
    pending_.changes.emplace_back(vat);
    pending_.has_state = false;
  });
}

void FrameFeed::set_default_error(double max_error) {
  put([&] { pending_.changes.emplace_back(DefaultError{max_error}); });
}

void FrameFeed::publish(PublishedState& state) {
  put([&] {
    std::swap(pending_.state, state);
    pending_.has_state = true;
  });
}

void FrameFeed::wake(ConnectionId client) {
  put([&] { pending_.woken.push_back(client); });
}

void FrameFeed::frame_rejected(ConnectionId client, std::uint32_t number) {
  put([&] { pending_.changes.emplace_back(Rejected{client, number}); });
}

void FrameFeed::post(std::function<void()> task) {
  boost::asio::post(strand_, std::move(task));
}

template <class Put>
void FrameFeed::put(Put&& put) {
  const std::lock_guard lock(mutex_);
  put();
  if (std::exchange(turn_scheduled_, true)) return;
  boost::asio::post(strand_, [self = shared_from_this()] { self->turn(); });
}

void FrameFeed::turn() {
  VAT_CHECK(strand_.running_in_this_thread());
  thread_local const bool is_low = (lower_thread_priority(kNiceness, "vat-frames"), true);
  static_cast<void>(is_low);
  {
    const std::lock_guard lock(mutex_);
    std::swap(pending_, active_changes_);
    turn_scheduled_ = false;
  }
  try {
    apply_pending_changes();
  } catch (const std::exception& error) {
    log_error("session {}: frames lost by a fault of the server: {}", session_, error.what());
  }
  active_changes_.changes.clear();
  active_changes_.has_state = false;
  active_changes_.woken.clear();
  active_changes_.serves_rest = false;
}

void FrameFeed::apply_pending_changes() {
  VAT_CHECK(strand_.running_in_this_thread());
  for (Change& change : active_changes_.changes) {
    if (auto* added = std::get_if<Added>(&change)) {
      delivery_.add(std::move(added->outbox), added->subscription, added->wish);
    } else if (const auto* client = std::get_if<ConnectionId>(&change)) {
      delivery_.remove(*client);
    } else if (const auto* error = std::get_if<DefaultError>(&change)) {
      delivery_.set_default_error(error->max_error);
    } else if (const auto* rejected = std::get_if<Rejected>(&change)) {
      delivery_.restart(rejected->client, rejected->number);
    } else {
      delivery_.set_vat(std::get<std::optional<Vat>>(change));
    }
  }
  send_frames();
  // In another turn, so that a newer state comes first.
  if (delivery_.has_rest()) put([&] { pending_.serves_rest = true; });
}

void FrameFeed::send_frames() {
  const SteadyClock::time_point now = clock_.now();
  if (active_changes_.has_state) return delivery_.publish(active_changes_.state, now);
  if (active_changes_.serves_rest) delivery_.serve_rest(now);
  delivery_.retry(active_changes_.woken, now);
}

}  // namespace vat
