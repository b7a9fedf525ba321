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

/// Outcome of a call that was started. The calling thread throws the error, not the thread of the
/// client as with std::future.
template <class Value>
class Pending {
 public:
  explicit Pending(std::future<Outcome<Value>> future) : future_(std::move(future)) {}

  /// Waits for the outcome and returns the result. Throws the CallError of a failed call. Only one
  /// call of get() or outcome() is possible.
  Value get() {
    Outcome<Value> outcome = future_.get();
    return std::move(outcome.value());
  }
  /// As get(), but returns the error.
  Outcome<Value> outcome() { return future_.get(); }
  /// Waits at most `time`. Returns whether get() would return at once.
  template <class Duration>
  bool wait_for(Duration time) const {
    return future_.wait_for(time) == std::future_status::ready;
  }

 private:
  std::future<Outcome<Value>> future_;
};

/// Client of a server with the protocol vat.v1. If the connection is lost, the client connects
/// again, continues as the same participant, and restores its subscription.
///
/// Threads: a thread of the client receives messages and calls all handlers, one at a time. Events
/// and frames are not stored: while a handler runs, further messages wait in the socket. A handler
/// must not throw, wait for a Pending, or destroy the client. All threads, also in
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

  /// Calls a method, for example SessionJoin. Throws std::invalid_argument if the params contain an
  /// enumerator `unknown` or text that is not UTF-8.
  template <class Method>
  Pending<typename Method::Result> call(const typename Method::Params& params = {});
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
Pending<typename Method::Result> Client::call(const typename Method::Params& params) {
  using Result = typename Method::Result;
  const auto promise = std::make_shared<std::promise<Outcome<Result>>>();
  call<Method>(params,
               [promise](Outcome<Result> outcome) { promise->set_value(std::move(outcome)); });
  return Pending<Result>(promise->get_future());
}

template <class Method>
bool Client::notify(const typename Method::Params& params) {
  Json written;
  write_json(written, params);
  return start_notification(Method::kName, written);
}

}  // namespace vat::client
