// TLS on the port: https and wss, from TLS 1.2.

#include <arpa/inet.h>
#include <netinet/in.h>
#include <openssl/ssl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>

#include "tests/server/transport/transport_fixture.h"
#include "tests/support/certificate.h"
#include "tests/support/temporary_folder.h"

namespace vat::test::transport_tls_test {

namespace {

/// A peer that offers one version of TLS. Every call ends within kPatience.
class TlsClient {
 public:
  TlsClient(std::uint16_t port, int version)
      : context_(SSL_CTX_new(TLS_client_method()), SSL_CTX_free),
        tls_(nullptr, SSL_free),
        socket_(socket(AF_INET, SOCK_STREAM, 0)) {
    const timeval patience{kPatience.count(), 0};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    setsockopt(socket_, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0) {
      throw std::runtime_error("no connection");
    }
    SSL_CTX_set_min_proto_version(context_.get(), version);
    SSL_CTX_set_max_proto_version(context_.get(), version);
    SSL_CTX_set_security_level(context_.get(), 0);  // otherwise OpenSSL does not offer old versions
    tls_.reset(SSL_new(context_.get()));
    SSL_set_fd(tls_.get(), socket_);
    is_open_ = SSL_connect(tls_.get()) == 1;
  }
  ~TlsClient() { close(socket_); }
  TlsClient(const TlsClient&) = delete;
  TlsClient& operator=(const TlsClient&) = delete;

  bool is_open() const { return is_open_; }
  /// Returns the common name of the server's certificate.
  std::string server_name() const {
    const Owned<X509> certificate(SSL_get1_peer_certificate(tls_.get()), X509_free);
    std::array<char, 100> name{};
    X509_NAME_get_text_by_NID(X509_get_subject_name(certificate.get()), NID_commonName, name.data(),
                              static_cast<int>(name.size()));
    return name.data();
  }
  void write(std::string_view bytes) {
    if (SSL_write(tls_.get(), bytes.data(), static_cast<int>(bytes.size())) <= 0) {
      throw std::runtime_error("the peer has gone");
    }
  }
  /// Returns at least `size` bytes, or all bytes until the end.
  std::string read(std::size_t size) {
    std::string bytes;
    std::array<char, 65536> part;
    while (bytes.size() < size) {
      const int count = SSL_read(tls_.get(), part.data(), static_cast<int>(part.size()));
      if (count <= 0) break;
      bytes.append(part.data(), static_cast<std::size_t>(count));
    }
    return bytes;
  }

 private:
  Owned<SSL_CTX> context_;
  Owned<SSL> tls_;
  int socket_;
  bool is_open_ = false;
};

class TransportTlsTest : public TransportTest {
 protected:
  TransportTlsTest() {
    settings.tls_certificate = folder.file("certificate.pem");
    settings.tls_key = folder.file("key.pem");
    write_certificate(settings.tls_certificate, settings.tls_key);
  }
  /// Returns the error of creating the transport.
  std::string failure() {
    try {
      start();
      return "";
    } catch (const std::runtime_error& error) {
      return error.what();
    }
  }

  TemporaryFolder folder;
};

constexpr std::size_t kToTheEnd = static_cast<std::size_t>(-1);

TEST_F(TransportTlsTest, ServesPagesFromVersion12) {
  http_handler = [](const HttpRequest&) {
    return HttpResponse{200, "text/plain", std::string(3'000'000, 'x'), {}};
  };
  start();
  for (const int version : {TLS1_2_VERSION, TLS1_3_VERSION}) {
    TlsClient client(port, version);
    ASSERT_TRUE(client.is_open());
    client.write("GET / HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
    const HttpReply reply = parse_reply(client.read(kToTheEnd));
    EXPECT_EQ(reply.status, 200);
    EXPECT_EQ(reply.body.size(), 3'000'000U);
  }
  for (const int version : {TLS1_VERSION, TLS1_1_VERSION}) {
    EXPECT_FALSE(TlsClient(port, version).is_open()) << version;
  }
}

TEST_F(TransportTlsTest, CarriesWebSockets) {
  recorder.echo = true;
  start();
  TlsClient client(port, TLS1_3_VERSION);
  ASSERT_TRUE(client.is_open());
  client.write("GET /ws HTTP/1.1\r\nHost: 127.0.0.1\r\n" + upgrade_headers() + "\r\n");
  EXPECT_NE(client.read(1).find(" 101 "), std::string::npos);
  const std::string message(100'000, 'm');
  client.write(client_frame(1, message));
  const std::string echoed = client.read(message.size() + 10);
  EXPECT_EQ(echoed.substr(10), message);
  transport->stop();
  EXPECT_EQ(client.read(4).substr(2, 2), "\x03\xe9") << "1001";
}

TEST_F(TransportTlsTest, AnswersNothingInPlainText) {
  start();
  RawClient client(port);
  client.write("GET / HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
  EXPECT_EQ(client.read_all().find("HTTP/"), std::string::npos);
  EXPECT_TRUE(TlsClient(port, TLS1_3_VERSION).is_open());
}

// The library's time limit is 5 s.
TEST_F(TransportTlsTest, AHandshakeThatNeverEndsIsCutOff) {
  start();
  RawClient silent(port);
  RawClient half(port);
  half.write(std::string("\x16\x03\x01\x02", 4));
  EXPECT_EQ(silent.read_all(), "");
  EXPECT_EQ(half.read_all(), "");
}

TEST_F(TransportTlsTest, ANewCertificateIsForNewConnections) {
  recorder.echo = true;
  settings.endpoints = 2;
  start();
  TlsClient before(port, TLS1_3_VERSION);
  EXPECT_EQ(before.server_name(), "a test");
  before.write("GET /ws HTTP/1.1\r\nHost: 127.0.0.1\r\n" + upgrade_headers() + "\r\n");
  EXPECT_NE(before.read(1).find(" 101 "), std::string::npos);
  write_certificate(settings.tls_certificate, settings.tls_key, "DNS:localhost", "renewed");
  transport->read_certificate();
  for (int i = 0; i < 20; ++i) {  // on both endpoints
    EXPECT_EQ(TlsClient(port, TLS1_3_VERSION).server_name(), "renewed");
  }
  before.write(client_frame(1, "still here"));
  EXPECT_EQ(before.read(12).substr(2), "still here");
}

TEST_F(TransportTlsTest, ABrokenCertificateLeavesThePreviousOne) {
  start();
  folder.write("certificate.pem", "not a certificate");
  try {
    transport->read_certificate();
    ADD_FAILURE() << "accepted";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()).find(settings.tls_certificate), 0U) << error.what();
  }
  EXPECT_EQ(TlsClient(port, TLS1_3_VERSION).server_name(), "a test");
}

// The header is valid for all ports of a name, so that localhost does not get it.
TEST_F(TransportTlsTest, OnlyPublicNamesGetStrictTransportSecurity) {
  settings.public_names = {"vat.example"};
  start();
  for (const auto& [host, expected] : {std::pair("vat.example", "max-age=31536000"),
                                       std::pair("localhost", ""), std::pair("127.0.0.1", "")}) {
    TlsClient client(port, TLS1_3_VERSION);
    client.write("GET / HTTP/1.1\r\nHost: " + std::string(host) + "\r\nConnection: close\r\n\r\n");
    EXPECT_EQ(parse_reply(client.read(kToTheEnd)).header("Strict-Transport-Security"), expected);
  }
}

TEST_F(TransportTlsTest, AConnectionServesSeveralRequests) {
  start();
  TlsClient client(port, TLS1_3_VERSION);
  for (const char* target : {"/one", "/two"}) {
    client.write("GET " + std::string(target) + " HTTP/1.1\r\nHost: localhost\r\n\r\n");
    std::string reply;
    while (!reply.ends_with(target)) {
      const std::string part = client.read(1);
      ASSERT_NE(part, "") << "the connection is closed";
      reply += part;
    }
    EXPECT_EQ(parse_reply(reply).status, 200);
  }
}

TEST_F(TransportTlsTest, FilesThatCannotBeUsedAreNamed) {
  const TransportSettings good = settings;
  settings.tls_certificate = folder.file("none.pem");
  EXPECT_EQ(failure().find(settings.tls_certificate + ": cannot be read as a certificate"), 0U)
      << failure();
  settings = good;
  write_certificate(folder.file("other.pem"), folder.file("other-key.pem"));
  settings.tls_key = folder.file("other-key.pem");
  EXPECT_EQ(failure().find(settings.tls_key + ": cannot be read as the key"), 0U) << failure();
  settings = good;
  folder.write("key.pem", "not a key");
  EXPECT_EQ(failure().find(settings.tls_key + ": cannot be read as the key"), 0U) << failure();
}

}  // namespace

}  // namespace vat::test::transport_tls_test
