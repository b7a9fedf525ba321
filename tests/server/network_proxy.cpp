#include "tests/server/network_proxy.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <limits>
#include <stdexcept>
#include <utility>

namespace vat::test {
namespace {

constexpr std::size_t kMostHeld = 256 * 1024;  // bytes of a way
constexpr int kReceiveBuffer = 16 * 1024;      // of the system: what waits is to wait here
constexpr double kBurst = 1500;                // bytes that a limited rate lets go at once

sockaddr_in loopback(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

void prepare(int socket) {
  const int on = 1;
  setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  fcntl(socket, F_SETFL, fcntl(socket, F_GETFL) | O_NONBLOCK);
}

}  // namespace

NetworkProxy::NetworkProxy(std::uint16_t server_port, Line line)
    : line_(line), server_port_(server_port) {
  listener_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address = loopback(0);
  socklen_t size = sizeof address;
  if (bind(listener_, reinterpret_cast<const sockaddr*>(&address), size) != 0 ||
      listen(listener_, 1) != 0 ||
      getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
    throw std::runtime_error("the proxy cannot listen");
  }
  port_ = ntohs(address.sin_port);
  thread_ = std::thread([this] { run(); });
}

NetworkProxy::~NetworkProxy() {
  stopping_ = true;
  shutdown(listener_, SHUT_RDWR);
  thread_.join();
  close(listener_);
}

void NetworkProxy::set(Line line) {
  const std::lock_guard lock(mutex_);
  line_ = line;
}

NetworkProxy::Line NetworkProxy::line() {
  const std::lock_guard lock(mutex_);
  return line_;
}

void NetworkProxy::run() {
  const int client = accept(listener_, nullptr, nullptr);
  if (client < 0) return;
  const int server = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  setsockopt(server, SOL_SOCKET, SO_RCVBUF, &kReceiveBuffer, sizeof kReceiveBuffer);
  const sockaddr_in address = loopback(server_port_);
  bool is_open = connect(server, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  prepare(client);
  prepare(server);
  Way to_client;
  Way to_server;
  double allowance = 0;
  auto before = Clock::now();
  while (is_open && !stopping_) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    const Line now = line();
    const auto time = Clock::now();
    const std::chrono::duration<double> passed = time - std::exchange(before, time);
    if (now.is_broken) continue;
    allowance = std::min(kBurst, allowance + now.bytes_per_second * passed.count());
    double unlimited = std::numeric_limits<double>::max();
    is_open = take(server, to_client, now) && take(client, to_server, now) &&
              pass_on(client, to_client, now.bytes_per_second > 0 ? allowance : unlimited) &&
              pass_on(server, to_server, unlimited);
  }
  close(client);
  close(server);
}

bool NetworkProxy::take(int from, Way& way, const Line& line) {
  std::array<char, 4096> bytes;
  while (way.held < kMostHeld && !way.has_ended) {
    const ssize_t got = recv(from, bytes.data(), bytes.size(), 0);
    if (got < 0) return errno == EAGAIN || errno == EINTR;
    way.has_ended = got == 0;
    if (got == 0) break;
    const auto size = static_cast<std::size_t>(got);
    way.parcels.push_back({Clock::now() + line.delay, {bytes.data(), size}});
    way.held += size;
    if (size < bytes.size()) break;
  }
  return true;
}

/// False once all has been passed on that there will be.
bool NetworkProxy::pass_on(int to, Way& way, double& allowance) {
  while (!way.parcels.empty() && way.parcels.front().due <= Clock::now() && allowance >= 1) {
    std::string& bytes = way.parcels.front().bytes;
    const std::size_t most =
        std::min(bytes.size(), static_cast<std::size_t>(std::min(allowance, 1e6)));
    const ssize_t sent = send(to, bytes.data(), most, MSG_NOSIGNAL);
    if (sent < 0) return errno == EAGAIN || errno == EINTR;
    const auto size = static_cast<std::size_t>(sent);
    allowance -= static_cast<double>(size);
    way.held -= size;
    bytes.erase(0, size);
    if (bytes.empty()) way.parcels.pop_front();
  }
  return !way.has_ended || !way.parcels.empty();
}

}  // namespace vat::test
