#include "tests/server/transport/transport_client.h"

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <cstdlib>
#include <stdexcept>

namespace vat::test {

namespace {

namespace asio = boost::asio;
using boost::system::error_code;

}  // namespace

template <class Start>
void RawClient::await(Start&& start) {
  bool done = false;
  start(done);
  io_.restart();
  io_.run_for(kPatience);
  if (done) return;
  socket_.close();
  io_.run();  // the aborted handlers refer to the caller's stack
  throw std::runtime_error("no answer within the patience of the test");
}

RawClient::RawClient(std::uint16_t port, const char* from) : socket_(io_) {
  socket_.open(asio::ip::tcp::v4());
  socket_.bind({asio::ip::make_address(from), 0});
  socket_.connect({asio::ip::make_address("127.0.0.1"), port});
}

void RawClient::write(std::string_view bytes) {
  error_code result;
  await([&](bool& done) {
    asio::async_write(socket_, asio::buffer(bytes), [&](error_code error, std::size_t) {
      result = error;
      done = true;
    });
  });
  if (result) throw std::runtime_error("write: " + result.message());
}

std::string RawClient::read_some() {
  // Asio reports the end of a stream only once: a further read would wait without end.
  if (has_ended_) return {};
  std::array<char, 65536> buffer;
  std::size_t size = 0;
  await([&](bool& done) {
    socket_.async_read_some(asio::buffer(buffer), [&](error_code, std::size_t count) {
      size = count;
      done = true;
    });
  });
  has_ended_ = size == 0;
  return {buffer.data(), size};
}

std::string RawClient::read_exactly(std::size_t size) {
  std::string bytes(size, '\0');
  await([&](bool& done) {
    asio::async_read(socket_, asio::buffer(bytes), [&](error_code, std::size_t count) {
      bytes.resize(count);
      done = true;
    });
  });
  return bytes;
}

std::string RawClient::read_all() {
  std::string all;
  for (std::string part = read_some(); !part.empty(); part = read_some()) all += part;
  return all;
}

void RawClient::end_sending() {
  error_code ignored;  // the peer can have closed the connection
  socket_.shutdown(asio::socket_base::shutdown_send, ignored);
}

void RawClient::reset() {
  socket_.set_option(asio::socket_base::linger(true, 0));
  socket_.close();
}

void RawClient::close() {
  socket_.close();
}

std::string HttpReply::header(std::string_view name) const {
  const std::string key = "\r\n" + std::string(name) + ": ";
  const std::size_t start = head.find(key);
  if (start == std::string::npos) return {};
  const std::size_t value = start + key.size();
  return head.substr(value, head.find("\r\n", value) - value);
}

HttpReply parse_reply(const std::string& bytes) {
  HttpReply reply;
  const std::size_t end = bytes.find("\r\n\r\n");
  if (!bytes.starts_with("HTTP/1.1 ") || end == std::string::npos) return reply;
  reply.status = std::atoi(bytes.c_str() + 9);
  reply.head = bytes.substr(0, end + 2);
  reply.body = bytes.substr(end + 4);
  return reply;
}

namespace {

std::string request(std::uint16_t port, std::string_view method, std::string_view target,
                    std::string_view headers, std::string_view body) {
  return std::string(method) + " " + std::string(target) +
         " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) + "\r\n" + std::string(headers) +
         "\r\n" + std::string(body);
}

/// Reads the head of a reply. `rest` receives the bytes after it.
HttpReply read_head(RawClient& client, std::string& rest) {
  std::string bytes;
  while (bytes.find("\r\n\r\n") == std::string::npos) {
    const std::string part = client.read_some();
    if (part.empty()) throw std::runtime_error("the connection ended in the reply's head");
    bytes += part;
  }
  const std::size_t end = bytes.find("\r\n\r\n") + 4;
  rest = bytes.substr(end);
  return parse_reply(bytes.substr(0, end));
}

}  // namespace

HttpReply http(std::uint16_t port, std::string_view method, std::string_view target,
               std::string_view headers, std::string_view body) {
  RawClient client(port);
  client.write(request(port, method, target, "Connection: close\r\n" + std::string(headers), body));
  return parse_reply(client.read_all());
}

HttpReply http_again(RawClient& client, std::string_view target, std::string_view headers) {
  client.write(request(80, "GET", target, headers, ""));
  std::string rest;
  HttpReply reply = read_head(client, rest);
  const std::size_t size = std::stoul(reply.header("Content-Length"));
  if (rest.size() < size) rest += client.read_exactly(size - rest.size());
  reply.body = rest;
  return reply;
}

int status_for_host(std::uint16_t port, const std::string& host, const std::string& headers) {
  RawClient client(port);
  client.write("GET /ws HTTP/1.1\r\nHost: " + host + "\r\n" + headers + "\r\n");
  std::string rest;
  return read_head(client, rest).status;
}

std::string client_frame(int opcode, std::string_view payload, bool final) {
  constexpr std::array<unsigned char, 4> kMask{0x12, 0x34, 0x56, 0x78};
  std::string frame{static_cast<char>((final ? 0x80 : 0) | opcode)};
  const std::uint64_t size = payload.size();
  const int length_bytes = size < 126 ? 0 : size < 65536 ? 2 : 8;
  frame += static_cast<char>(0x80 | (length_bytes == 0 ? size : length_bytes == 2 ? 126u : 127u));
  for (int i = length_bytes - 1; i >= 0; --i) frame += static_cast<char>(size >> (8 * i));
  for (const unsigned char byte : kMask) frame += static_cast<char>(byte);
  for (std::size_t i = 0; i < size; ++i) frame += static_cast<char>(payload[i] ^ kMask[i % 4]);
  return frame;
}

std::string upgrade_headers(std::string_view subprotocol, std::string_view version) {
  std::string headers =
      "Upgrade: websocket\r\nConnection: Upgrade\r\n"
      "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n";
  if (!version.empty()) headers += "Sec-WebSocket-Version: " + std::string(version) + "\r\n";
  if (!subprotocol.empty()) {
    headers += "Sec-WebSocket-Protocol: " + std::string(subprotocol) + "\r\n";
  }
  return headers;
}

HttpReply try_upgrade(std::uint16_t port, std::string_view target, std::string_view headers) {
  RawClient client(port);
  client.write(request(port, "GET", target, headers, ""));
  std::string rest;
  HttpReply reply = read_head(client, rest);
  if (reply.status != 101) reply.body = rest + client.read_all();
  return reply;
}

WsClient::WsClient(std::uint16_t port, const char* from) : raw_(port, from) {
  raw_.write(request(port, "GET", "/ws", upgrade_headers(), ""));
  const HttpReply reply = read_head(raw_, buffer_);
  if (reply.status != 101) throw std::runtime_error("upgrade refused: " + reply.head);
}

std::optional<Frame> WsClient::read_frame() {
  const auto fill = [this](std::size_t size) {
    while (buffer_.size() < size) {
      const std::string part = raw_.read_some();
      if (part.empty()) return false;
      buffer_ += part;
    }
    return true;
  };
  const auto byte = [this](std::size_t i) { return static_cast<unsigned char>(buffer_[i]); };
  if (!fill(2)) return std::nullopt;
  std::uint64_t size = byte(1);
  std::size_t header = 2;
  if (size >= 126) {
    const std::size_t length_bytes = size == 126 ? 2 : 8;
    if (!fill(header + length_bytes)) return std::nullopt;
    size = 0;
    for (std::size_t i = 0; i < length_bytes; ++i) size = size << 8 | byte(header + i);
    header += length_bytes;
  }
  if (!fill(header + size)) return std::nullopt;
  Frame frame{byte(0) & 15, buffer_.substr(header, size)};
  buffer_.erase(0, header + size);
  return frame;
}

Frame WsClient::read_message() {
  for (;;) {
    const std::optional<Frame> frame = read_frame();
    if (!frame) throw std::runtime_error("the connection ended");
    if (frame->opcode == 1 || frame->opcode == 2) return *frame;
    if (frame->opcode == 8) throw std::runtime_error("close frame: " + frame->payload.substr(2));
  }
}

int WsClient::read_close() {
  while (const std::optional<Frame> frame = read_frame()) {
    if (frame->opcode != 8) continue;
    if (frame->payload.size() < 2) return 0;
    const int code = static_cast<unsigned char>(frame->payload[0]) << 8 |
                     static_cast<unsigned char>(frame->payload[1]);
    try {
      raw_.write(client_frame(8, frame->payload.substr(0, 2)));
    } catch (const std::runtime_error&) {  // the server need not wait for the reply
    }
    return code;
  }
  return 0;
}

}  // namespace vat::test
