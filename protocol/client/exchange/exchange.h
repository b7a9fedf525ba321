#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/client/connection/connection.h"
#include "protocol/client/exchange/call_list.h"
#include "protocol/client/exchange/frame_receiver.h"
#include "protocol/client/exchange/options.h"

namespace vat::client {

/// State of a client, without sockets and threads. It enters the server, joins again after a
/// reconnection, restores the subscription, acknowledges frames, and detects a silent connection.
/// The caller opens and closes connections as state() requires, passes received messages, and sends
/// the output of the list of calls. Only `calls` may be used by other threads.
class Exchange {
 public:
  /// `options`, `handlers` and `calls` must outlive the exchange. `seed` selects the random part of
  /// the delays of reconnections.
  Exchange(const Options& options, const Handlers& handlers, CallList& calls, std::uint32_t seed);

  ConnectionState state() const { return state_; }
  /// Returns the time of the next attempt to connect, in the state `waiting`.
  Time retry_time() const { return retry_time_; }
  /// Returns the URL of the next attempt to connect. "": the URL of the application.
  const std::string& next_url() const { return next_url_; }
  /// Returns the time of the next check(), if no message arrives earlier.
  Time next_check() const;

  /// The caller starts to connect, after the state `waiting`.
  void start_connecting();
  /// A connection is open. The client enters before the state becomes `open`.
  void connected(Time now);
  /// Processes a message of the connection.
  void receive(const Message& message, Time now);
  /// The connection failed, or was lost. `close_code` 0: without a close frame.
  void lost(std::uint16_t close_code, const std::string& reason, Time now);
  /// Ends expired calls, and checks whether the server answers.
  void check(Time now);
  /// Ends all calls and the client.
  void close(const std::string& reason);

 private:
  void change(ConnectionState state, std::string reason = {},
              std::chrono::milliseconds retry_in = {});
  void fail_calls(const std::string& reason);
  /// Calls a method for the client itself. `proceed` receives the result. If the call fails, the
  /// client reconnects or closes.
  void request(const char* method, Json params, const std::function<void(const Json&)>& proceed);
  void start_call(const char* method, Json params,
                  const std::function<void(Outcome<Json>)>& settle);
  void fail(const CallError& error);

  void enter_with(const std::vector<std::string>& tokens, bool needs_token);
  /// Connects to another node of the cluster, at once for the first times.
  void redirect(const std::string& url);
  /// Follows a session that a call of the application names. Returns false for other errors.
  bool follow(const Call& call, const CallError& error);
  void rejoin();
  void finish_rejoin(const Json& result);
  void become_open();
  void forget_session();
  void probe();

  void receive_text(const std::string& text);
  void receive_reply(const Json& message);
  /// Stores the session, subscription and token that a successful call has changed.
  void remember(const Call& call, const Json& result);
  void receive_event(const std::string& name, const Json& params);
  void receive_frame(std::span<const std::uint8_t> bytes);
  void describe(const SessionDescription& description);
  void report(const std::string& fault) const;

  const Options& options_;
  const Handlers& handlers_;
  CallList& calls_;
  std::minstd_rand random_;
  FrameReceiver receiver_;

  ConnectionState state_ = ConnectionState::connecting;
  Time now_{};  ///< time of the present call
  Time connected_at_{};
  Time retry_time_{};
  Time last_message_{};
  bool is_connected_ = false;
  bool is_probing_ = false;
  bool was_open_ = false;
  bool has_session_ended_ = false;
  int attempts_ = 0;
  int redirects_ = 0;               ///< since the last join
  std::string next_url_;            ///< see next_url()
  std::vector<std::string> nodes_;  ///< URLs of the cluster's nodes
  std::size_t next_node_ = 0;
  std::optional<Call> moved_join_;  ///< session.join of the application, for another node

  std::string token_;                   ///< last accepted token
  std::string resume_;                  ///< token of the participant
  std::optional<std::string> session_;  ///< id of the joined session
  Json join_params_;
  Json subscription_;  ///< params of the subscription; null if the client has no subscription
};

}  // namespace vat::client
