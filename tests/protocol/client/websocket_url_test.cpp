#include "protocol/client/connection/websocket_url.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace vat::client::websocket_url_test {
namespace {

TEST(WebSocketUrl, HasHostPortPathAndScheme) {
  struct Case {
    const char* text;
    const char* host;
    const char* port;
    const char* path;
    const char* authority;
    bool is_secure = false;
  };
  for (const auto& [text, host, port, path, authority, is_secure] :
       {Case{"ws://example.org", "example.org", "80", "/ws", "example.org:80"},
        Case{"ws://example.org/", "example.org", "80", "/ws", "example.org:80"},
        Case{"ws://127.0.0.1:8080/a/b", "127.0.0.1", "8080", "/a/b", "127.0.0.1:8080"},
        Case{"ws://[::1]:9/ws", "::1", "9", "/ws", "[::1]:9"},
        Case{"ws://example.org:443", "example.org", "443", "/ws", "example.org:443"},
        Case{"wss://example.org", "example.org", "443", "/ws", "example.org:443", true},
        Case{"wss://a.b:8080/c", "a.b", "8080", "/c", "a.b:8080", true}}) {
    const WebSocketUrl url = read_websocket_url(text);
    EXPECT_EQ(url.host, host) << text;
    EXPECT_EQ(url.port, port) << text;
    EXPECT_EQ(url.path, path) << text;
    EXPECT_EQ(url.authority(), authority) << text;
    EXPECT_EQ(url.is_secure, is_secure) << text;
  }
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
