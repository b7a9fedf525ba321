#pragma once

#include <deque>
#include <vector>

#include "protocol/client/connection/connection.h"
#include "protocol/frame/frame_codec.h"
#include "server/script/frame_json.h"
#include "server/script/script.h"
#include "server/script/transcript.h"

namespace vat::script {

using Connect = std::function<client::Connected(const client::ConnectRequest&)>;
/// Function that returns the response to GET for a path, see fetch_http().
using Fetch = std::function<Json(const std::string& path, client::Deadline deadline)>;

/// Exception: an expectation of a script line failed. The text contains the line, the expectation
/// and the received message.
struct Failure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Interpreter of scripts. protocol/SCRIPTS.md lists the actions.
///
/// In addition, every received message must be a JSON-RPC object or a valid frame. The frame
/// numbers of a client must have no gaps, and frames must belong to the epoch of the last
/// description.
class Player {
 public:
  /// `patience` is the default time limit of a line.
  Player(Connect connect, std::chrono::milliseconds patience)
      : connect_(std::move(connect)), patience_(patience) {}

  /// Sets the value of a capture.
  void set(const std::string& name, Json value) { captures_[name] = std::move(value); }

  /// Sets the function for lines with the action `fetch`. Without the function, such lines are
  /// invalid.
  void fetch_by(Fetch fetch) { fetch_ = std::move(fetch); }

  /// Records sent and received messages. `transcript` must outlive the player.
  void record(Transcript& transcript) { transcript_ = &transcript; }

  /// Runs the lines. Throws Failure at the first failed expectation, and ScriptError for an invalid
  /// line.
  void play(const std::vector<Line>& lines);

 private:
  /// Client, and received messages that no line has used yet.
  struct Peer {
    std::string connection;  ///< name of the connection in the transcript
    std::unique_ptr<client::Connection> socket;
    std::deque<Json> replies;
    std::deque<Json> events;
    std::deque<Json> frames;
    std::optional<client::Message> closed;
    FrameDecoder decoder;
    std::optional<std::uint64_t> epoch;  ///< epoch of the last description
    BodyNames names;                     ///< from the last description
  };
  using Inbox = std::deque<Json> Peer::*;

  void play_line(const Json& line);
  void run_action(const std::string& action, const Json& line);
  void repeat(const Json& line);
  void connect(const Json& line);
  void fetch(const Json& line);
  void send(const Json& line);
  void call(const Json& line);
  void wait_ticks(const Json& line);
  void notify(const Json& line);
  void expect_reply(const Json& line);
  void wait_for(const Json& line, const char* action, Inbox inbox);
  void expect_frame(const Json& line);
  void expect_none(const Json& line);
  void expect_close(const Json& line);

  std::string name_of(const Json& name) const;
  Peer& peer_of(const Json& line);
  client::Deadline deadline_of(const Json& line) const;
  /// Receives a message into the inboxes. Returns false if no message arrives before the deadline.
  bool receive(Peer& peer, client::Deadline deadline);
  void send_text(Peer& peer, const std::string& text, const Json& line);
  /// Sends a request and waits for its reply.
  Json request(Peer& peer, const Json& method, const Json& params, const Json& line);
  void receive_text(Peer& peer, const std::string& text);
  /// Stores the epoch and the body names of a description.
  static void learn_description(Peer& peer, const Json& content);
  void receive_frame(Peer& peer, const std::string& bytes);
  /// Removes and returns the first element of the inbox that satisfies `wanted`.
  template <class Wanted>
  std::optional<Json> take(Peer& peer, Inbox inbox, client::Deadline deadline, Wanted&& wanted);
  void require(const Json& pattern, const Json& value);

  Connect connect_;
  Fetch fetch_;
  std::chrono::milliseconds patience_;
  Transcript* transcript_ = nullptr;
  int connections_ = 0;
  std::map<std::string, Peer> peers_;
  Captures captures_;
  /// Last request id of the action `call`. Ids in scripts must be smaller.
  std::int64_t last_id_ = 1'000'000;
};

}  // namespace vat::script
