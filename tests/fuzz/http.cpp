#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "server/access/access.h"
#include "server/http/http_site.h"
#include "server/transport/transport.h"
#include "tests/fuzz/target.h"
#include "tests/server/transport/transport_client.h"
#include "tests/support/temporary_folder.h"

namespace {

using namespace vat;

/// Sends every message back.
class Echo final : public ConnectionHandler {
 public:
  void opened(std::shared_ptr<Connection> connection) override {
    VAT_CHECK(!connection->address().empty());
    const ConnectionId id = connection->id();
    VAT_CHECK(connections_.emplace(id, std::move(connection)).second);
  }
  void text_received(ConnectionId id, std::string_view message) override {
    connections_.at(id)->send_text(std::string(message));
  }
  void binary_received(ConnectionId id, std::string_view message) override {
    connections_.at(id)->send_binary(std::make_shared<const std::string>(message));
  }
  void closed(ConnectionId id) override { VAT_CHECK(connections_.erase(id) == 1); }

 private:
  std::map<ConnectionId, std::shared_ptr<Connection>> connections_;
};

HttpHandler make_site(const test::TemporaryFolder& folder) {
  folder.write("index.html", "the page");
  folder.write("assets/main.js", "the program");
  folder.write("assets/main.js.br", "brotli");
  folder.write("assets/main.js.gz", "gzip");
  AccessSettings access;
  access.mode = AccessMode::token;
  access.metrics = hash_of_token("token");
  return make_http_site(StaticFiles::read(folder.path()).value(),
                        {[] { return "vat_threads 1\n"; }, [] { return "{}"; },
                         [access](std::string_view text) { return may_read_metrics(access, text); },
                         [] { return ServerPhase::ready; }, [] { return "{}"; }, "{}"});
}

/// A server of which 127.0.0.1 is a trusted proxy. A fault in the server ends the process.
class Served {
 public:
  Served() : transport_(make_websocket_transport(settings(), echo_, make_site(folder_))) {
    port_ = transport_->start();
  }
  ~Served() { transport_->stop(); }
  Served(const Served&) = delete;
  Served& operator=(const Served&) = delete;

  std::uint16_t port() const { return port_; }

 private:
  static TransportSettings settings() {
    TransportSettings settings;
    settings.port = 0;
    settings.public_names = {"vat.example"};
    settings.trusted_proxies = {"127.0.0.1"};
    settings.max_message_bytes = 4096;
    // Short, so that an input that the server does not answer takes little time.
    settings.handshake_timeout = std::chrono::milliseconds(50);
    settings.ping_interval = std::chrono::milliseconds(50);
    settings.report = [](std::string_view fault) { VAT_CHECK(fault.empty()); };
    return settings;
  }

  const test::TemporaryFolder folder_;
  Echo echo_;
  std::unique_ptr<Transport> transport_;
  std::uint16_t port_ = 0;
};

/// Returns false if the server has closed the connection.
bool send(test::RawClient& client, std::string_view bytes) {
  try {
    client.write(bytes);
    return true;
  } catch (const std::runtime_error&) {
    return false;
  }
}

/// Checks the first reply.
void check_reply(const std::string& bytes) {
  if (bytes.empty()) return;  // the server closed the connection during the request
  const test::HttpReply reply = test::parse_reply(bytes);
  VAT_CHECK(reply.status == 101 || (reply.status >= 200 && reply.status < 500));
  VAT_CHECK(reply.status != 200 || reply.header("X-Content-Type-Options") == "nosniff");
  VAT_CHECK(reply.status != 101 || reply.header("Sec-WebSocket-Protocol") == "vat.v1");
}

}  // namespace

/// The input contains the bytes of a connection. A '~' separates parts: the next part is sent after
/// a reply to the part before. The server answers with an HTTP response, and always closes the
/// connection.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Served served;
  test::RawClient client(served.port());
  std::string replies;
  std::string_view text = fuzz::to_text(data, size);
  bool is_open = true;
  while (is_open && !text.empty()) {
    const std::string_view part = text.substr(0, text.find('~'));
    text.remove_prefix(std::min(part.size() + 1, text.size()));
    if (part.empty()) continue;
    is_open = send(client, part);
    if (is_open && !text.empty()) replies += client.read_some();
  }
  client.end_sending();
  check_reply(replies + client.read_all());
  return 0;
}
