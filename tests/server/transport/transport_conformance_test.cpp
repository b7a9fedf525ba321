// Server cases of RFC 6455 in the order of Autobahn's groups: framing, pings, reserved bits and
// opcodes, fragmentation, UTF-8, closing. transport_message_test.cpp covers limits.

#include "tests/server/transport/transport_fixture.h"

namespace vat::test::transport_conformance_test {

namespace {

constexpr int kText = 1;
constexpr int kBinary = 2;
constexpr int kClose = 8;
constexpr int kPing = 9;
constexpr int kPong = 10;

class WebSocketConformance : public TransportTest {
 protected:
  WebSocketConformance() {
    recorder.echo = true;
    start();
  }
  /// Returns the close code that these bytes cause.
  int closed_by(const std::string& bytes) {
    WsClient client(port);
    client.raw().write(bytes);
    return client.read_close();
  }
  std::string echoed(const std::string& bytes) {
    WsClient client(port);
    client.raw().write(bytes);
    return client.read_message().payload;
  }
};

std::string close_frame(int code, const std::string& reason = "") {
  std::string payload{static_cast<char>(code / 256), static_cast<char>(code % 256)};
  return client_frame(kClose, payload + reason);
}

// Group 1: text and binary frames of every size, and the bounds of the three length formats.
TEST_F(WebSocketConformance, Framing) {
  for (const std::size_t size : {0U, 1U, 125U, 126U, 127U, 128U, 65535U, 65536U, 1000000U}) {
    for (const int opcode : {kText, kBinary}) {
      EXPECT_EQ(echoed(client_frame(opcode, std::string(size, '*'))), std::string(size, '*'));
    }
  }
}

// Group 2: pings of every size are answered with their payload. Unsolicited pongs are not.
TEST_F(WebSocketConformance, PingsAndPongs) {
  for (const std::string& payload :
       {std::string(), std::string("\x00\xff\xfe", 3), std::string(125, 'p')}) {
    WsClient client(port);
    client.raw().write(client_frame(kPong, "unsolicited") + client_frame(kPing, payload));
    const auto pong = client.read_frame();
    ASSERT_TRUE(pong);
    EXPECT_EQ(pong->opcode, kPong);
    EXPECT_EQ(pong->payload, payload);
  }
  EXPECT_EQ(closed_by(client_frame(kPing, std::string(126, 'p'))), 1002);
  EXPECT_EQ(closed_by(client_frame(kPing, "p", false)), 1002);
}

// Group 3: each of the reserved bits, in text, ping and close.
TEST_F(WebSocketConformance, ReservedBits) {
  for (const int bit : {0x10, 0x20, 0x40, 0x70}) {
    for (const int opcode : {kText, kPing, kClose}) {
      std::string frame = client_frame(opcode, "");
      frame[0] = static_cast<char>(frame[0] | bit);
      EXPECT_EQ(closed_by(frame), 1002) << bit << ' ' << opcode;
    }
  }
}

// Group 4: each of the reserved opcodes.
TEST_F(WebSocketConformance, ReservedOpcodes) {
  for (const int opcode : {3, 4, 5, 6, 7, 11, 12, 13, 14, 15}) {
    EXPECT_EQ(closed_by(client_frame(opcode, "")), 1002) << opcode;
    EXPECT_EQ(closed_by(client_frame(opcode, "x")), 1002) << opcode;
  }
}

// Group 5: fragments with control frames between them, a missing start, and a start within a
// message.
TEST_F(WebSocketConformance, Fragmentation) {
  EXPECT_EQ(
      echoed(client_frame(kText, "a", false) + client_frame(0, "b", false) + client_frame(0, "c")),
      "abc");
  EXPECT_EQ(
      echoed(client_frame(kText, "", false) + client_frame(0, "", false) + client_frame(0, "")),
      "");
  WsClient between(port);
  between.raw().write(client_frame(kText, "a", false) + client_frame(kPing, "now") +
                      client_frame(0, "b"));
  EXPECT_EQ(between.read_frame()->payload, "now");
  EXPECT_EQ(between.read_message().payload, "ab");
  EXPECT_EQ(closed_by(client_frame(0, "x")), 1002);
  EXPECT_EQ(closed_by(client_frame(0, "x", false)), 1002);
  EXPECT_EQ(closed_by(client_frame(kText, "a", false) + client_frame(kText, "b")), 1002);
  EXPECT_EQ(closed_by(client_frame(kBinary, "a", false) + client_frame(kBinary, "b", false)), 1002);
  EXPECT_EQ(closed_by(client_frame(kText, "a") + client_frame(0, "b")), 1002);
}

// Every byte is a separate packet.
TEST_F(WebSocketConformance, FramesByteByByte) {
  WsClient client(port);
  for (const char byte : client_frame(kText, "slowly")) client.raw().write({&byte, 1});
  EXPECT_EQ(client.read_message().payload, "slowly");
}

// Group 6: valid UTF-8. The longest sequence of each length, in one frame and split within a
// character.
TEST_F(WebSocketConformance, GoodUtf8) {
  for (const std::string& text :
       {std::string("\xce\xba\xe1\xbd\xb9\xcf\x83\xce\xbc\xce\xb5"), std::string("\0", 1),
        std::string("\x7f"), std::string("\xdf\xbf"), std::string("\xef\xbf\xbf"),
        std::string("\xf4\x8f\xbf\xbf"), std::string("\xed\x9f\xbf"),
        std::string("\xee\x80\x80")}) {
    EXPECT_EQ(echoed(client_frame(kText, text)), text);
    EXPECT_EQ(
        echoed(client_frame(kText, text.substr(0, 1), false) + client_frame(0, text.substr(1))),
        text);
  }
}

// Invalid UTF-8: bad start bytes, truncated and overlong sequences, surrogates, and values beyond
// the last plane.
TEST_F(WebSocketConformance, BadUtf8) {
  for (const std::string& text :
       {std::string("\xce\xba\xe1\xbd\xb9\xed\xa0\x80"), std::string("\x80"),
        std::string("\xc0\x80"), std::string("\xe0\x80\x80"), std::string("\xf0\x80\x80\x80"),
        std::string("\xf5\x80\x80\x80"), std::string("\xf4\x90\x80\x80"), std::string("\xfe"),
        std::string("\xff"), std::string("\xc3"), std::string("\xe1\xbd"),
        std::string("\xed\xbf\xbf")}) {
    EXPECT_EQ(closed_by(client_frame(kText, text)), 1007) << testing::PrintToString(text);
    EXPECT_EQ(closed_by(client_frame(kText, "ok", false) + client_frame(0, text)), 1007);
  }
  EXPECT_EQ(recorder.read([this] { return recorder.received.size(); }), 0U);
  EXPECT_EQ(echoed(client_frame(kBinary, "\xff")), "\xff");
}

// Group 7: the server echoes permitted codes. Forbidden codes, half a code and reasons that are not
// UTF-8 close with 1002. The server does not answer after a close.
TEST_F(WebSocketConformance, CloseCodes) {
  for (const int code :
       {1000, 1001, 1002, 1003, 1007, 1008, 1009, 1010, 1011, 3000, 3999, 4000, 4999}) {
    EXPECT_EQ(closed_by(close_frame(code)), code);
    EXPECT_EQ(closed_by(close_frame(code, "because")), code);
  }
  for (const int code : {0, 999, 1004, 1005, 1006, 1015, 5000, 65535}) {
    EXPECT_EQ(closed_by(close_frame(code)), 1002) << code;
  }
  EXPECT_EQ(closed_by(client_frame(kClose, "\x03")), 1002);
  EXPECT_EQ(closed_by(client_frame(kClose, std::string(126, 'x'))), 1002);
  EXPECT_EQ(closed_by(close_frame(1000, "\xff")), 1002);
  EXPECT_EQ(closed_by(close_frame(1000) + client_frame(kText, "too late")), 1000);
}

// Client frames must be masked.
TEST_F(WebSocketConformance, UnmaskedFrames) {
  for (const char opcode : {'\x81', '\x82', '\x89', '\x88'}) {
    EXPECT_EQ(closed_by(std::string{opcode, '\x00'}), 1002);
  }
}

}  // namespace

}  // namespace vat::test::transport_conformance_test
