#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <thread>

namespace vat::test {

/// A long, thin or broken line between one client and a server on this machine: passes bytes on
/// after a delay, at a limited rate, or not at all for a while. What it holds is bounded, as in a
/// router, so that the ends feel it. Loss is a break: TCP sends again, and all after it waits.
class NetworkProxy {
 public:
  struct Line {
    std::chrono::milliseconds delay{0};  ///< each way
    double bytes_per_second = 0;         ///< to the client; 0: no limit
    bool is_broken = false;
  };

  NetworkProxy(std::uint16_t server_port, Line line);
  ~NetworkProxy();
  NetworkProxy(const NetworkProxy&) = delete;
  NetworkProxy& operator=(const NetworkProxy&) = delete;

  std::uint16_t port() const { return port_; }
  void set(Line line);

 private:
  using Clock = std::chrono::steady_clock;
  struct Parcel {
    Clock::time_point due;
    std::string bytes;
  };
  /// Bytes under way from one socket to the other.
  struct Way {
    std::deque<Parcel> parcels;
    std::size_t held = 0;
    bool has_ended = false;
  };
  void run();
  bool take(int from, Way& way, const Line& line);
  bool pass_on(int to, Way& way, double& allowance);
  Line line();

  std::mutex mutex_;
  Line line_;
  const std::uint16_t server_port_;
  int listener_ = -1;
  std::uint16_t port_ = 0;
  std::atomic<bool> stopping_ = false;
  std::thread thread_;
};

}  // namespace vat::test
