#pragma once

#include <functional>
#include <future>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "protocol/client/exchange/call_error.h"
#include "protocol/client/exchange/options.h"
#include "protocol/client/methods/invalid_value.h"
#include "protocol/client/methods/methods.h"

namespace vat::client {

/// Exception: the server cannot be reached, is not trusted, or does not admit the client.
struct ConnectError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Client of a server with the protocol vat.v1. If the connection is lost, the client connects
/// again, continues as the same participant, and restores its subscription.
///
/// Threads: a thread of the client receives messages and calls all handlers, one at a time. Events
/// and frames are not stored: while a handler runs, further messages wait in the socket. A handler
/// must not throw, wait for the future of a call, or destroy the client. All threads, also in
/// handlers, may call the member functions.
class Client {
 public:
  /// Connects to "ws://HOST[:PORT][/PATH]" or a wss:// URL, and waits until calls are possible.
  /// Throws std::invalid_argument for an invalid URL or option, and ConnectError with the cause if
  /// the first attempt fails.
  explicit Client(const std::string& url, Options options = {}, Handlers handlers = {});
  /// As close().
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  /// Calls a method, for example SessionJoin. The future has the result, or throws a CallError.
  /// Throws std::invalid_argument if the params contain an enumerator `unknown` or text that is not
  /// UTF-8.
  template <class Method>
  std::future<typename Method::Result> call(const typename Method::Params& params = {});
  /// Calls a method. `handler` receives the outcome on the thread of the client. If the call cannot
  /// be sent, this thread calls `handler` before the function returns.
  template <class Method>
  void call(const typename Method::Params& params,
            std::function<void(Outcome<typename Method::Result>)> handler);
  /// Sends a notification, which has no reply. Returns false if there is no connection or too many
  /// messages wait. Throws as call().
  template <class Method>
  bool notify(const typename Method::Params& params = {});

  /// Sends the waiting messages and closes the connection. Calls without replies fail with the kind
  /// `disconnected`. The participant can be resumed for some time, unless SessionLeave was called.
  /// A handler that calls this function continues, and the connection closes after its return.
  void close();

 private:
  class Impl;
  void start_call(const char* method, Json params,
                  const std::function<void(Outcome<Json>)>& settle);
  bool start_notification(const char* method, const Json& params);

  std::unique_ptr<Impl> impl_;
};

template <class Method>
void Client::call(const typename Method::Params& params,
                  std::function<void(Outcome<typename Method::Result>)> handler) {
  Json written;
  write_json(written, params);
  start_call(Method::kName, std::move(written),
             [handler = std::move(handler)](Outcome<Json> outcome) {
               if (!outcome) return handler(outcome.error());
               typename Method::Result result;
               try {
                 read_json(outcome.value(), result);
               } catch (const InvalidValue& error) {
                 return handler(
                     CallError("invalid_reply", std::string(Method::kName) + ": " + error.what()));
               }
               handler(std::move(result));
             });
}

template <class Method>
std::future<typename Method::Result> Client::call(const typename Method::Params& params) {
  const auto promise = std::make_shared<std::promise<typename Method::Result>>();
  call<Method>(params, [promise](Outcome<typename Method::Result> outcome) {
    if (outcome) {
      promise->set_value(std::move(outcome.value()));
    } else {
      promise->set_exception(std::make_exception_ptr(outcome.error()));
    }
  });
  return promise->get_future();
}

template <class Method>
bool Client::notify(const typename Method::Params& params) {
  Json written;
  write_json(written, params);
  return start_notification(Method::kName, written);
}

}  // namespace vat::client
