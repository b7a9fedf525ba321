#pragma once

#include <boost/asio/thread_pool.hpp>
#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "protocol/frame/frame_codec.h"
#include "server/frames/frame_feed.h"
#include "server/relay/relay_message.h"

namespace vat {

/// Frames of a session of another node. The owner sends each state once, on its finest grid. The
/// feed encodes it again for the viewers at this node. Thread-safe.
class RelayFeed {
 public:
  struct Place {
    std::string session;
    std::string owner;          ///< name of the node
    std::uint64_t epoch = 0;    ///< of the owner
    std::string link;           ///< beginning of its links, unique in the cluster
    std::string owner_subject;  ///< subject on which the owner listens
    std::string own_subject;    ///< subject of the messages to this feed
  };
  /// The arguments must outlive the feed and the threads of `pool`.
  RelayFeed(Place place, NatsConnection& connection, ServerMetrics& metrics,
            boost::asio::thread_pool& pool, const Clock& clock);
  /// Ends the link.
  ~RelayFeed();
  RelayFeed(const RelayFeed&) = delete;
  RelayFeed& operator=(const RelayFeed&) = delete;

  const Place& place() const { return place_; }
  const std::shared_ptr<FrameFeed>& frames() const { return frames_; }
  /// Adds or replaces a viewer. Its first frame follows as soon as the owner's frames have the
  /// attributes that the viewer wants.
  void add(std::shared_ptr<ClientOutbox> outbox, std::uint64_t subscription,
           const Subscription& wanted);
  void remove(ConnectionId viewer);
  /// Sends the last state to the viewer again, which may have refused it.
  void repeat(ConnectionId viewer);
  /// Returns the tick of the last frame, or 0.
  std::uint64_t tick() const;

  /// Takes a message of the owner.
  void receive(const std::string& bytes);
  /// Opens another link if the owner is silent, and closes viewers who acknowledge no frame for
  /// `patience`. Call it about once per second.
  void look(std::chrono::seconds patience);

 private:
  struct Viewer {
    std::shared_ptr<ClientOutbox> outbox;
    std::uint64_t subscription = 0;
    Subscription wanted;
    bool is_waiting = true;  ///< for frames with the attributes that it wants
  };
  // The caller must hold the mutex for these functions.
  void receive_frame(const std::string& bytes);
  void receive_facts(const std::string& text);
  /// Opens a link, in place of the last one.
  void open_line();
  void update_watch();
  bool has_attributes_of(const Subscription& wanted) const;
  void admit_waiting();
  void publish();

  const Place place_;
  NatsConnection& connection_;
  const Clock& clock_;
  const std::shared_ptr<FrameFeed> frames_;

  mutable OwnedMutex mutex_;  // guards the members below
  std::map<ConnectionId, Viewer> viewers_;
  ByAttribute<double> watched_{};  // errors of the attributes that the owner was asked for
  bool is_watching_ = false;
  bool is_broken_ = false;  // the link has ended
  SteadyClock::time_point heard_{};
  std::unique_ptr<RelayLine> line_;
  std::uint64_t lines_ = 0;
  RelayInput received_;
  FrameDecoder decoder_;
  const GridFrame* last_ = nullptr;  // of `decoder_`
  PublishedState state_;             // reused memory
};

}  // namespace vat
