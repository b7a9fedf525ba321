#include "protocol/client/connection/websocket_url.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace vat::client::websocket_url_test {
namespace {

TEST(WebSocketUrl, HasADefaultPortAndPath) {
  const WebSocketUrl url = read_websocket_url("ws://example.org");
  EXPECT_EQ(url.host, "example.org");
  EXPECT_EQ(url.port, "80");
  EXPECT_EQ(url.path, "/ws");
  EXPECT_EQ(url.authority(), "example.org:80");
  EXPECT_EQ(read_websocket_url("ws://example.org/").path, "/ws");
}

TEST(WebSocketUrl, NamesPortAndPath) {
  const WebSocketUrl url = read_websocket_url("ws://127.0.0.1:8080/behind/proxy");
  EXPECT_EQ(url.host, "127.0.0.1");
  EXPECT_EQ(url.port, "8080");
  EXPECT_EQ(url.path, "/behind/proxy");
}

TEST(WebSocketUrl, AddressesOfIpv6StandInBrackets) {
  const WebSocketUrl url = read_websocket_url("ws://[::1]:9/ws");
  EXPECT_EQ(url.host, "::1");
  EXPECT_EQ(url.port, "9");
  EXPECT_EQ(url.authority(), "[::1]:9");
}

TEST(WebSocketUrl, IsSecureByItsScheme) {
  EXPECT_FALSE(read_websocket_url("ws://example.org:443").is_secure);
  const WebSocketUrl url = read_websocket_url("wss://example.org");
  EXPECT_TRUE(url.is_secure);
  EXPECT_EQ(url.authority(), "example.org:443");
  EXPECT_EQ(read_websocket_url("wss://example.org:8080/there").authority(), "example.org:8080");
}

TEST(WebSocketUrl, RefusesInvalidUrls) {
  for (const char* text : {"", "localhost:80", "http://localhost", "ws://", "wss://", "wss:/h",
                           "ws://:80", "ws:///ws", "ws://h:", "ws://h:x", "ws://h:65536",
                           "ws://h:1e2", "ws://[::1", "ws://[::1]9", "ws://[]:1"}) {
    EXPECT_THROW(read_websocket_url(text), std::invalid_argument) << text;
  }
}

}  // namespace
}  // namespace vat::client::websocket_url_test
