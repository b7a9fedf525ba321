#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/support/names.h"
#include "protocol/json/json_reader.h"
#include "server/nats/nats_connection.h"
#include "server/support/owned_mutex.h"

namespace vat {

/// Kind of a message between a relay and the owner of a session. See server/CLUSTER.md.
enum class RelayKind : std::uint8_t {
  open,   ///< to the owner: a client connects. `fields` describe the client
  watch,  ///< to the owner: the relay wants the frames of a session, or other attributes
  text,   ///< both ways: a text message of the client, or for it
  frame,  ///< to the relay: an encoded frame
  ack,    ///< to the owner: a frame was decoded
  alive,  ///< both ways: the link exists; the owner answers
  end     ///< both ways: the link ends
};
template <>
inline constexpr std::array kNamesOf<RelayKind>{"open", "watch", "text", "frame",
                                                "ack",  "alive", "end"};

/// Message of a link. A link connects a client, or the viewers of a session at a relay, with the
/// owner of the session.
struct RelayMessage {
  RelayKind kind = RelayKind::end;
  std::string link;
  std::uint64_t number = 0;  ///< counts the messages of one direction of the link, from 1
  bool is_part = false;      ///< the body continues in the next message
  Json fields = Json::object();
  std::string body;
};

/// Returns the bytes of a message: a line of JSON, and the body.
std::string write_relay_message(const RelayMessage& message);
/// Returns the message, or nothing if the bytes are no message.
std::optional<RelayMessage> read_relay_message(std::string_view bytes);

/// Sender of one direction of a link. Thread-safe.
class RelayLine {
 public:
  /// The connection must outlive the line.
  RelayLine(NatsConnection& connection, std::string subject, std::string link)
      : connection_(connection), subject_(std::move(subject)), link_(std::move(link)) {}

  const std::string& link() const { return link_; }
  /// Sends a message, in parts if it is long. Returns false if there is no connection. The receiver
  /// then notices the loss by the number of the next message.
  bool send(RelayKind kind, Json fields = Json::object(), std::string body = {});

 private:
  NatsConnection& connection_;
  const std::string subject_;
  const std::string link_;
  OwnedMutex mutex_;  // so that messages are sent in the order of their numbers
  std::uint64_t number_ = 0;
};

/// Receiver of one direction of a link. Not thread-safe.
class RelayInput {
 public:
  enum class Taken {
    whole,  ///< `message` is complete
    part,   ///< further parts follow
    lost    ///< an earlier message was lost
  };
  /// Takes the next message. Joins the body of the last part with the bodies of the earlier parts.
  Taken take(RelayMessage& message);

 private:
  std::uint64_t last_ = 0;
  std::string parts_;
};

}  // namespace vat
