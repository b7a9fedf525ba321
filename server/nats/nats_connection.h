#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "server/nats/nats_error.h"

namespace vat {

/// Message of NATS.
struct NatsMessage {
  std::string subject;
  std::string reply_to;  ///< subject for the answer; empty: no answer is expected
  std::map<std::string, std::string> headers;
  std::string data;
};

struct NatsSettings {
  std::vector<std::string> urls;  ///< nats:// or tls:// URLs of the servers
  std::string name;               ///< name of the client in the server's lists
  std::string tls_ca;             ///< file with trusted certificates; empty: those of the system
  std::string tls_certificate;    ///< file with the certificate of this client; empty: none
  std::string tls_key;            ///< file with the key of `tls_certificate`
  std::string credentials;        ///< file with a user's credentials; empty: none
};

/// Connection to a group of NATS servers. Reconnects without end after the first connection.
/// Thread-safe. Handlers run on threads of the connection, and must not wait for requests.
class NatsConnection {
 public:
  using Result = std::variant<NatsMessage, NatsError>;
  using Handler = std::function<void(const NatsMessage&)>;
  using Headers = std::vector<std::pair<std::string, std::string>>;
  using Milliseconds = std::chrono::milliseconds;

  /// Ends the subscription when destroyed. A handler may still run for a short time then.
  class Subscription;

  /// Connects. Throws NatsError if no server answers.
  explicit NatsConnection(const NatsSettings& settings);
  /// As close().
  ~NatsConnection();
  NatsConnection(const NatsConnection&) = delete;
  NatsConnection& operator=(const NatsConnection&) = delete;

  /// Ends the connection. Fails all waiting requests, and calls no handler afterwards.
  void close();
  bool is_connected() const;
  /// Sets the function that is called after each reconnection. Call it before other functions.
  void on_reconnect(std::function<void()> function);

  /// Sends a message. Throws NatsError if there is no connection.
  void publish(const std::string& subject, const std::string& data);
  /// Sends a request, and calls `done` once with the answer or an error.
  void request(const std::string& subject, const Headers& headers, const std::string& data,
               Milliseconds timeout, std::function<void(Result)> done);
  /// As above, but waits for the answer. Throws NatsError.
  NatsMessage request(const std::string& subject, const std::string& data, Milliseconds timeout,
                      const Headers& headers = {});
  /// Calls `handler` for each message of the subject, which may contain wildcards.
  std::unique_ptr<Subscription> subscribe(const std::string& subject, Handler handler);
  /// Waits until the servers know all previous subscriptions and messages. Throws NatsError.
  void flush(Milliseconds timeout);

 private:
  struct Impl;
  const std::unique_ptr<Impl> impl_;
};

class NatsConnection::Subscription {
 public:
  struct State;
  explicit Subscription(std::shared_ptr<State> state) : state_(std::move(state)) {}
  ~Subscription();
  Subscription(const Subscription&) = delete;
  Subscription& operator=(const Subscription&) = delete;

 private:
  const std::shared_ptr<State> state_;
};

}  // namespace vat
