#include "tests/bench/fanout/viewer.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "tests/bench/fanout/frame_facts.h"

namespace vat::bench {
namespace {

constexpr int kStallAfter = 10;                                   // frames
constexpr auto kRequestInterval = std::chrono::milliseconds(50);  // server.info: reads_per_second
constexpr int kSmallReceiveBuffer = 64 * 1024;
constexpr std::size_t kLook = 2048;      // maximum of examined bytes
constexpr std::size_t kThrow = 1 << 20;  // maximum of bytes discarded at once
constexpr double kGrain = 0.01;          // [s] of a half-speed reader

std::string masked_text(const std::string& text) {
  constexpr std::array<unsigned char, 4> kMask{0x12, 0x34, 0x56, 0x78};
  std::string frame = "\x81";
  if (text.size() < 126) {
    frame += static_cast<char>(0x80 | text.size());
  } else {
    frame += static_cast<char>(0x80 | 126);
    frame += static_cast<char>(text.size() >> 8);
    frame += static_cast<char>(text.size());
  }
  for (const unsigned char byte : kMask) frame += static_cast<char>(byte);
  for (std::size_t i = 0; i < text.size(); ++i) {
    frame += static_cast<char>(static_cast<unsigned char>(text[i]) ^ kMask[i % 4]);
  }
  return frame;
}

std::string upgrade_request(std::uint16_t port) {
  return "GET /ws HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) +
         "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
         "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n"
         "Sec-WebSocket-Protocol: vat.v1\r\n\r\n";
}

double wall_clock() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration<double>(now).count();
}

float seconds_since(LoadClock::time_point begin) {
  return std::chrono::duration<float>(LoadClock::now() - begin).count();
}

}  // namespace

const char* name_of(ViewerKind kind) {
  constexpr std::array<const char*, kViewerKinds> kNames{"plain",    "half",   "stalled",
                                                         "restless", "reader", "silent"};
  return kNames[static_cast<std::size_t>(kind)];
}

Viewer::Viewer(ViewerKind kind, const LoadSettings& settings, std::uint32_t seed)
    : kind_(kind), settings_(settings), random_(seed) {}

Viewer::~Viewer() {
  reset();
}

void Viewer::reset() {
  if (socket_ >= 0) close(socket_);
  socket_ = -1;
  stage_ = Stage::closed;
  has_frame_ = false;
  frames_ = 0;
  reply_.clear();
  head_size_ = start_size_ = 0;
  left_ = size_ = 0;
}

void Viewer::connect() {
  reset();
  socket_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (socket_ < 0) throw std::runtime_error(std::string("no socket: ") + std::strerror(errno));
  const int on = 1;
  setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  if (kind_ == ViewerKind::half || kind_ == ViewerKind::stalled || kind_ == ViewerKind::silent) {
    setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &kSmallReceiveBuffer, sizeof kSmallReceiveBuffer);
  }
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(settings_.port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    throw std::runtime_error(std::string("cannot connect: ") + std::strerror(errno));
  }
  send_all(upgrade_request(settings_.port));
  fcntl(socket_, F_SETFL, fcntl(socket_, F_GETFL) | O_NONBLOCK);
  stage_ = Stage::upgrading;
  leaves_ = LoadClock::now() + std::chrono::milliseconds(500 + random_() % 1500);
  allowed_ = LoadClock::now();
}

bool Viewer::read(Sightings& sightings) {
  for (;;) {
    const bool throws_away = stage_ == Stage::open && left_ > kLook && start_size_ == start_.size();
    const std::size_t wanted =
        readable_now(throws_away ? std::min<std::uint64_t>(left_, kThrow) : kLook);
    if (wanted == 0) return false;
    std::array<char, kLook> bytes;
    const ssize_t got = throws_away ? recv(socket_, nullptr, wanted, MSG_TRUNC)
                                    : recv(socket_, bytes.data(), std::min(wanted, kLook), 0);
    if (got <= 0) {
      if (got < 0 && (errno == EAGAIN || errno == EINTR)) return true;
      lose(sightings);
      return false;
    }
    const auto size = static_cast<std::size_t>(got);
    allowance_ -= static_cast<double>(size);
    if (throws_away) {
      left_ -= size;
      if (left_ == 0) end_message(sightings);
    } else {
      take(bytes.data(), size, sightings);
    }
    if (size < wanted && throws_away) return true;
    if (kind_ == ViewerKind::stalled && frames_ >= kStallAfter) return false;
    if (kind_ == ViewerKind::silent && stage_ == Stage::open) return false;
  }
}

std::size_t Viewer::readable_now(std::size_t wanted) {
  if (kind_ != ViewerKind::half || stage_ != Stage::open) return wanted;
  return std::min(wanted, static_cast<std::size_t>(std::max(0.0, allowance_)));
}

bool Viewer::look_at_clock(LoadClock::time_point now, Sightings& sightings) {
  if (kind_ == ViewerKind::restless && now >= leaves_) {
    ++sightings.joins;
    connect();
    return true;
  }
  if (kind_ == ViewerKind::reader && has_frame_ && now >= next_request_) {
    next_request_ = now + kRequestInterval;
    send_text(R"({"jsonrpc":"2.0","id":1,"method":"state.query"})");
  }
  if (kind_ != ViewerKind::half || settings_.half_bytes_per_second <= 0) return false;
  const double rate = settings_.half_bytes_per_second;
  allowance_ += rate * std::chrono::duration<double>(now - allowed_).count();
  allowance_ = std::min(allowance_, rate * kGrain * 2);
  allowed_ = now;
  return allowance_ > rate * kGrain;
}

void Viewer::send_text(const std::string& text) {
  send_all(masked_text(text));
}

/// Such a short message always fits into the socket's buffer unless the server has closed. Reading
/// then reports that.
void Viewer::send_all(const std::string& bytes) {
  [[maybe_unused]] const ssize_t sent = send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
}

void Viewer::take(const char* bytes, std::size_t size, Sightings& sightings) {
  while (size > 0) {
    std::size_t used = 0;
    if (stage_ == Stage::upgrading) {
      used = take_reply(bytes, size);
    } else if (left_ == 0) {
      used = take_head(bytes, size);
      if (used > 0 && head_size_ == 0 && left_ == 0) end_message(sightings);
    } else {
      used = static_cast<std::size_t>(std::min<std::uint64_t>(size, left_));
      const std::size_t kept = std::min(used, start_.size() - start_size_);
      std::copy_n(bytes, kept, start_.begin() + static_cast<std::ptrdiff_t>(start_size_));
      start_size_ += kept;
      left_ -= used;
      if (left_ == 0) end_message(sightings);
    }
    bytes += used;
    size -= used;
  }
}

std::size_t Viewer::take_reply(const char* bytes, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i) {
    reply_ += bytes[i];
    if (!reply_.ends_with("\r\n\r\n")) continue;
    if (!reply_.starts_with("HTTP/1.1 101")) throw std::runtime_error("refused: " + reply_);
    stage_ = Stage::open;
    subscribed_ = LoadClock::now();
    // A silent viewer requests the reply, because it contains the description.
    const char* const id = kind_ == ViewerKind::silent ? R"("id":0,)" : "";
    send_text(std::string(R"({"jsonrpc":"2.0",)") + id +
              R"("method":"session.join","params":{"session":")" + settings_.session + "\"}}");
    if (kind_ == ViewerKind::silent) {
      has_frame_ = true;  // it is ready, and requests no frame
      return i + 1;
    }
    send_text(R"({"jsonrpc":"2.0","method":"frames.subscribe","params":{"max_error":)" +
              std::to_string(settings_.max_error) + R"(,"attributes":{"speed":1e-5}}})");
    return i + 1;
  }
  return size;
}

/// Parses the head of a WebSocket message. The server's messages are unfragmented and not masked.
std::size_t Viewer::take_head(const char* bytes, std::size_t size) {
  for (std::size_t used = 1; used <= size; ++used) {
    head_[head_size_++] = static_cast<unsigned char>(bytes[used - 1]);
    if (head_size_ < 2) continue;
    const std::size_t length_bytes = head_[1] < 126 ? 0 : head_[1] == 126 ? 2 : 8;
    if (head_size_ < 2 + length_bytes) continue;
    size_ = length_bytes == 0 ? head_[1] : 0;
    for (std::size_t i = 2; i < 2 + length_bytes; ++i) size_ = size_ << 8 | head_[i];
    opcode_ = head_[0] & 15;
    left_ = size_;
    head_size_ = start_size_ = 0;
    return used;
  }
  return size;
}

void Viewer::end_message(Sightings& sightings) {
  constexpr int kBinary = 2;
  constexpr int kPing = 9;
  if (opcode_ == kBinary) end_frame(sightings);
  if (opcode_ == kPing) {
    send_all(std::string("\x8a\x80\x12\x34\x56\x78", 6));
  }
}

void Viewer::end_frame(Sightings& sightings) {
  const FrameFacts facts = frame_facts({start_.data(), start_size_});
  if (!has_frame_) sightings.first_frames.push_back(seconds_since(subscribed_));
  has_frame_ = true;
  ++frames_;
  ++sightings.frames;
  sightings.bytes += size_;
  sightings.ages.push_back(static_cast<float>(wall_clock() - facts.published));
  send_text(acknowledgement(facts));
}

void Viewer::lose(Sightings& sightings) {
  ++sightings.closed;
  reset();
}

}  // namespace vat::bench
