#pragma once

#include <boost/asio/thread_pool.hpp>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "protocol/frame/frame_codec.h"
#include "server/frames/frame_feed.h"
#include "server/relay/frame_facts.h"
#include "server/relay/relay_message.h"

namespace vat {

/// Frames of a session of another node. The owner sends each state once, on its finest grid. The
/// feed encodes it again for the viewers at this node. Thread-safe.
class RelayFeed : public std::enable_shared_from_this<RelayFeed> {
 public:
  struct Place {
    std::string session;
    std::string owner;          ///< name of the node
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

  /// Listens to the owner. Call it once.
  void start();
  const std::string& owner() const { return place_.owner; }
  const std::shared_ptr<FrameFeed>& frames() const { return frames_; }
  /// Adds or replaces a viewer. Its first frame follows as soon as the owner's frames have the
  /// attributes that the viewer wants.
  void add(std::shared_ptr<ClientOutbox> outbox, std::uint64_t subscription,
           const Subscription& wanted);
  void remove(ConnectionId viewer);
  /// Returns whether no further frame follows.
  bool has_ended() const;
  /// Returns the tick of the last frame, or 0.
  std::uint64_t tick() const;

 private:
  struct Viewer {
    Subscription wanted;
    // Not null: the viewer waits for frames with its attributes.
    std::shared_ptr<ClientOutbox> waiting;
    std::uint64_t subscription = 0;
  };
  void receive(const std::string& bytes);
  void end();
  void receive_frame(const std::string& bytes);
  void receive_facts(const std::string& text);
  // The caller must hold the mutex for these functions.
  /// Opens a link, or another one after the loss of a message.
  void open_line();
  void update_watch();
  bool has_attributes_of(const Subscription& wanted) const;
  void admit_waiting();
  void publish();

  const Place place_;
  NatsConnection& connection_;
  const std::shared_ptr<FrameFeed> frames_;

  mutable OwnedMutex mutex_;  // guards the members below
  std::map<ConnectionId, Viewer> viewers_;
  ByAttribute<double> watched_{};  // errors of the attributes that the owner was asked for
  bool is_watching_ = false;
  bool has_ended_ = false;
  std::unique_ptr<RelayLine> line_;
  std::uint64_t lines_ = 0;
  RelayInput received_;
  FrameDecoder decoder_;
  const GridFrame* last_ = nullptr;  // of `decoder_`
  PublishedState state_;             // reused memory
  std::unique_ptr<NatsConnection::Subscription> subscription_;
};

}  // namespace vat
