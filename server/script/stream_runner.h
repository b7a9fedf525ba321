#pragma once

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/ssl.hpp>
#include <chrono>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "server/script/tls.h"

namespace vat::script {

using PlainStream = boost::beast::tcp_stream;
using SecureStream = boost::beast::ssl_stream<boost::beast::tcp_stream>;

/// Opens a stream, and runs its operations on the caller's thread, inside the calls below.
template <class Stream>
class StreamRunner {
 public:
  using Deadline = std::chrono::steady_clock::time_point;
  using ErrorCode = boost::system::error_code;
  static constexpr bool kIsSecure = std::is_same_v<Stream, SecureStream>;

  explicit StreamRunner(const TlsTrust& trust) {
    if constexpr (kIsSecure) tls_.emplace(make_client_context(trust));
  }

  /// A stream, or what is built on one.
  template <class Layer = Stream>
  Layer make() {
    if constexpr (kIsSecure) {
      return Layer(context_, *tls_);
    } else {
      return Layer(context_);
    }
  }

  /// Connects, with the certificate checked. Throws std::runtime_error.
  void open(Stream& stream, const WebSocketUrl& url, Deadline deadline) {
    connect(stream, url, deadline);
    if constexpr (kIsSecure) {
      expect_server(stream.native_handle(), url);
      std::optional<ErrorCode> outcome;
      stream.async_handshake(boost::asio::ssl::stream_base::client,
                             [&](ErrorCode failure) { outcome = failure; });
      finish(stream, outcome, deadline, "the server did not answer the handshake of TLS in time");
      if (*outcome) {
        throw std::runtime_error(handshake_fault(stream.native_handle(), url, *outcome));
      }
    }
  }

  /// Runs an operation to its end, which `outcome` tells; throws where that is not by the deadline.
  void finish(Stream& stream, const std::optional<ErrorCode>& outcome, Deadline deadline,
              const char* fault) {
    run_until(deadline, [&] { return outcome.has_value(); });
    if (outcome) return;
    boost::beast::get_lowest_layer(stream).socket().close();
    run_until(Deadline::max(), [&] { return outcome.has_value(); });
    throw std::runtime_error(fault);
  }

  template <class Condition>
  void run_until(Deadline deadline, Condition&& reached) {
    run_ready();
    while (!reached() && std::chrono::steady_clock::now() < deadline) {
      context_.restart();
      const bool is_idle = context_.run_one_until(deadline) == 0 && context_.stopped();
      if (is_idle) return;  // nothing to wait for
    }
  }
  /// What can be done without waiting.
  void run_ready() {
    context_.restart();
    context_.poll();
  }
  /// Up to the end of all that is under way.
  void run_out() {
    context_.restart();
    context_.run();
  }

 private:
  void connect(Stream& stream, const WebSocketUrl& url, Deadline deadline) {
    boost::asio::ip::tcp::resolver resolver(context_);
    ErrorCode failure;
    const auto found = resolver.resolve(url.host, url.port, failure);
    if (failure) throw std::runtime_error("no address of " + url.host + ": " + failure.message());
    PlainStream& socket = boost::beast::get_lowest_layer(stream);
    std::optional<ErrorCode> outcome;
    socket.expires_at(deadline);
    socket.async_connect(found, [&](ErrorCode result, const auto&) { outcome = result; });
    run_until(Deadline::max(), [&] { return outcome.has_value(); });
    socket.expires_never();
    if (*outcome) {
      throw std::runtime_error("no server at " + url.authority() + ": " + outcome->message());
    }
  }

  boost::asio::io_context context_;
  std::optional<boost::asio::ssl::context> tls_;
};

}  // namespace vat::script
