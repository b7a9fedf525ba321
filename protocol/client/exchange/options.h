#pragma once

#include <chrono>
#include <functional>
#include <string>

#include "protocol/client/connection/websocket_url.h"
#include "protocol/client/exchange/frame.h"
#include "protocol/client/methods/methods.h"

namespace vat::client {

struct Options {
  /// Token of an admin, an invitation, a ticket or a participant. "": no token.
  std::string token = {};
  TlsTrust trust = {};
  /// Time limit of opening a connection. After this time without messages, the client checks the
  /// connection.
  std::chrono::milliseconds timeout{10'000};
  std::chrono::milliseconds call_timeout{60'000};  ///< time limit of a call
  /// Whether the client connects again after the loss of a connection.
  bool reconnects = true;
  /// Delay before the first attempt to reconnect. It doubles with each attempt up to
  /// `longest_retry`, plus a random part of at most a quarter.
  std::chrono::milliseconds first_retry{500};
  std::chrono::milliseconds longest_retry{8000};
};

enum class ConnectionState {
  connecting,
  open,     ///< calls are possible
  waiting,  ///< the connection was lost, and an attempt to reconnect follows
  closed    ///< the client does not reconnect
};

struct StateChange {
  ConnectionState state = ConnectionState::connecting;
  std::string reason = {};                ///< of `waiting` and `closed`
  std::chrono::milliseconds retry_in{0};  ///< `waiting`: time until the next attempt
};

/// Functions that a client calls, each of which can be empty.
struct Handlers {
  std::function<void(const StateChange&)> on_state = {};
  /// Receives each frame of the subscription. After its return, the client acknowledges the frame,
  /// so that the server sends further frames. The server drops frames for a slow function.
  std::function<void(const Frame&)> on_frame = {};
  /// Called after each reconnection to a session, before the state `open`. If the member `resumed`
  /// is false, this client is a new participant.
  std::function<void(const SessionJoin::Result&)> on_rejoined = {};
  /// Receives a fault of a message that no call can report, for example an invalid frame. The
  /// connection continues or is opened again.
  std::function<void(const std::string&)> on_fault = {};
  /// `events.session_description` is also called after each join, before the first frame.
  EventHandlers events = {};
};

}  // namespace vat::client
