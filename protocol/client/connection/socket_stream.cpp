#include "protocol/client/connection/socket_stream.h"

#include <openssl/ssl.h>
#include <openssl/x509v3.h>

#include <boost/asio/basic_stream_socket.hpp>
#include <boost/asio/connect.hpp>
#include <boost/asio/ip/address.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/ssl/stream.hpp>
#include <stdexcept>

namespace vat::client {

namespace asio = boost::asio;
using asio::ip::tcp;

namespace {

using ErrorCode = SocketStream::ErrorCode;

/// Returns a client context for TLS 1.2 and later. Throws std::runtime_error if the file cannot be
/// used.
asio::ssl::context make_client_context(const TlsTrust& trust) {
  asio::ssl::context context(asio::ssl::context::tls_client);
  SSL_CTX_set_min_proto_version(context.native_handle(), TLS1_2_VERSION);
  context.set_verify_mode(trust.is_unchecked ? asio::ssl::verify_none : asio::ssl::verify_peer);
  ErrorCode failure;
  if (trust.authority_file.empty()) {
    context.set_default_verify_paths(failure);
    if (failure) throw std::runtime_error("the system's certificates: " + failure.message());
  } else {
    context.load_verify_file(trust.authority_file, failure);
    if (failure) {
      throw std::runtime_error(trust.authority_file +
                               ": has no certificate in PEM that can be read");
    }
  }
  return context;
}

/// Requests the server at `url` in the handshake of `tls`, and accepts only its certificate.
void expect_server(SSL* tls, const WebSocketUrl& url) {
  ErrorCode no_address;
  boost::asio::ip::make_address(url.host, no_address);
  X509_VERIFY_PARAM* expected = SSL_get0_param(tls);
  if (no_address) {
    // SSL_set_tlsext_host_name() without its cast of the old kind.
    SSL_ctrl(tls, SSL_CTRL_SET_TLSEXT_HOSTNAME, TLSEXT_NAMETYPE_host_name,
             const_cast<char*>(url.host.c_str()));
    X509_VERIFY_PARAM_set1_host(expected, url.host.c_str(), url.host.size());
  } else {
    X509_VERIFY_PARAM_set1_ip_asc(expected, url.host.c_str());
  }
}

/// Throws the reason of a failed handshake.
[[noreturn]] void throw_handshake_fault(SSL* tls, const WebSocketUrl& url,
                                        const ErrorCode& failure) {
  const long found = SSL_get_verify_result(tls);
  if (found != X509_V_OK && SSL_get_verify_mode(tls) != SSL_VERIFY_NONE) {
    throw UntrustedServer("the certificate of " + url.authority() +
                          " is not trusted: " + X509_verify_cert_error_string(found));
  }
  throw std::runtime_error("no TLS with " + url.authority() + ": " + failure.message() +
                           "; a server without TLS is at ws://");
}

}  // namespace

struct SocketStream::Transport {
  using Socket = asio::basic_stream_socket<tcp, executor_type>;

  Transport(asio::io_context& context, const WebSocketUrl& url, const TlsTrust& trust)
      : socket(context.get_executor()) {
    if (!url.is_secure) return;
    tls_context.emplace(make_client_context(trust));
    tls.emplace(socket, *tls_context);
  }

  Socket socket;
  std::optional<asio::ssl::context> tls_context;
  std::optional<asio::ssl::stream<Socket&>> tls;  // empty: no TLS
};

SocketStream::SocketStream(asio::io_context& context, const WebSocketUrl& url,
                           const TlsTrust& trust)
    : context_(context), url_(url), transport_(std::make_unique<Transport>(context, url, trust)) {}

SocketStream::~SocketStream() = default;

SocketStream::executor_type SocketStream::get_executor() {
  return context_.get_executor();
}

void SocketStream::open(Deadline deadline) {
  // The context belongs to the caller's Operations; only this stream has operations in it yet.
  const auto run = [&](const std::optional<ErrorCode>& outcome) {
    context_.restart();
    while (!outcome && context_.run_one_until(deadline) > 0) {
    }
    const bool in_time = outcome.has_value();
    if (!in_time) {
      close_socket();
      context_.restart();
      context_.run();
    }
    return in_time;
  };
  tcp::resolver resolver(context_);
  ErrorCode failure;
  const auto found = resolver.resolve(url_.host, url_.port, failure);
  if (failure) throw std::runtime_error("no address of " + url_.host + ": " + failure.message());
  std::optional<ErrorCode> outcome;
  asio::async_connect(transport_->socket, found,
                      [&](ErrorCode result, const tcp::endpoint&) { outcome = result; });
  if (!run(outcome)) outcome = asio::error::timed_out;
  if (*outcome) {
    throw std::runtime_error("no server at " + url_.authority() + ": " + outcome->message());
  }
  // A frame's header and content are written one after the other: the second must not wait until
  // the server has acknowledged the first.
  transport_->socket.set_option(tcp::no_delay(true));
  if (!transport_->tls) return;
  SSL* const tls = transport_->tls->native_handle();
  expect_server(tls, url_);
  outcome.reset();
  transport_->tls->async_handshake(asio::ssl::stream_base::client,
                                   [&](ErrorCode result) { outcome = result; });
  if (!run(outcome)) {
    throw std::runtime_error("the server did not answer the handshake of TLS in time");
  }
  if (*outcome) throw_handshake_fault(tls, url_, *outcome);
}

void SocketStream::close_socket() {
  ErrorCode ignored;  // the peer may have closed it
  transport_->socket.close(ignored);
}

void SocketStream::start_read(asio::mutable_buffer buffer, Handler handler) {
  if (transport_->tls) {
    transport_->tls->async_read_some(buffer, std::move(handler));
  } else {
    transport_->socket.async_read_some(buffer, std::move(handler));
  }
}

void SocketStream::start_write(asio::const_buffer buffer, Handler handler) {
  if (transport_->tls) {
    transport_->tls->async_write_some(buffer, std::move(handler));
  } else {
    transport_->socket.async_write_some(buffer, std::move(handler));
  }
}

void SocketStream::start_teardown(std::function<void(ErrorCode)> handler) {
  if (transport_->tls) {
    transport_->tls->async_shutdown(std::move(handler));
    return;
  }
  ErrorCode failure;
  transport_->socket.shutdown(tcp::socket::shutdown_both, failure);
  asio::post(context_, [handler = std::move(handler), failure] { handler(failure); });
}

void Operations::finish(SocketStream& stream, const std::optional<SocketStream::ErrorCode>& outcome,
                        Deadline deadline, const char* fault) {
  run_until(deadline, [&] { return outcome.has_value(); });
  if (outcome) return;
  stream.close_socket();
  run_until(Deadline::max(), [&] { return outcome.has_value(); });
  throw std::runtime_error(fault);
}

void Operations::run_until(Deadline deadline, const std::function<bool()>& reached) {
  run_ready();
  while (!reached() && std::chrono::steady_clock::now() < deadline) {
    context_.restart();
    const bool is_idle = context_.run_one_until(deadline) == 0 && context_.stopped();
    if (is_idle) return;  // nothing to wait for
  }
}

void Operations::run_ready() {
  context_.restart();
  context_.poll();
}

void Operations::run_out() {
  context_.restart();
  context_.run();
}

}  // namespace vat::client
