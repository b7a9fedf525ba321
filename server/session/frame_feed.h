#pragma once

#include <boost/asio/strand.hpp>
#include <boost/asio/thread_pool.hpp>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "server/session/frame_delivery.h"

namespace vat {

/// The way of a session's frames to those who watch it: a strand on the pool of the frame threads,
/// which give way to all others, so that no tick waits for an encoder. Where the strand is still
/// busy with a state, the newest takes the place of the one that waits. Safe to use from any
/// thread.
class FrameFeed final : public FrameWaker, public std::enable_shared_from_this<FrameFeed> {
 public:
  FrameFeed(std::string session, const std::optional<Vat>& vat, ServerMetrics& metrics,
            boost::asio::thread_pool& pool, const Clock& clock);

  /// What is done here takes effect before a state that is published later. True where a state that
  /// waited was dropped, since it may lack what the new one wants: one should be published soon.
  bool add(std::shared_ptr<ClientOutbox> outbox, std::uint64_t subscription, Subscription wish);
  void remove(ConnectionId client);
  void set_vat(const std::optional<Vat>& vat);
  /// See FrameDelivery.
  void set_default_error(double max_error);

  /// Takes the state, and leaves an older one in its place, whose memory the next may use: so a
  /// tick allocates nothing for what it publishes.
  void publish(PublishedState& state);
  void wake(ConnectionId client) override;
  /// Runs `task` after all that was put here before.
  void post(std::function<void()> task);

 private:
  struct Added {
    std::shared_ptr<ClientOutbox> outbox;
    std::uint64_t subscription;
    Subscription wish;
  };
  struct DefaultError {
    double max_error;
  };
  using Change = std::variant<Added, ConnectionId, std::optional<Vat>, DefaultError>;
  struct PendingChanges {
    std::vector<Change> changes;
    PublishedState state;
    bool has_state = false;  // or it is an older one's memory
    std::vector<ConnectionId> woken;
  };
  template <class Put>
  void put(Put&& put);
  void turn();
  void apply_pending_changes();

  const std::string session_;
  const Clock& clock_;
  boost::asio::strand<boost::asio::thread_pool::executor_type> strand_;

  std::mutex mutex_;
  PendingChanges pending_;
  bool turn_scheduled_ = false;

  // Used on the strand only.
  PendingChanges mail_at_work_;  // empty between turns, but for memory
  FrameDelivery delivery_;
};

}  // namespace vat
