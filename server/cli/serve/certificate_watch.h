#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <functional>
#include <string>
#include <vector>

namespace vat {

/// Reads the certificate again after SIGHUP, and after a change of its files. Logs the result.
class CertificateWatch {
 public:
  static constexpr std::chrono::milliseconds kInterval{10'000};

  /// `read` reads the certificate. It throws std::exception if a file is invalid.
  CertificateWatch(boost::asio::io_context& io, std::vector<std::string> files,
                   std::function<void()> read, std::chrono::milliseconds interval = kInterval);
  CertificateWatch(const CertificateWatch&) = delete;
  CertificateWatch& operator=(const CertificateWatch&) = delete;

 private:
  void wait_for_signal();
  void wait_for_change();
  void read_again();

  const std::vector<std::string> files_;
  const std::function<void()> read_;
  const std::chrono::milliseconds interval_;
  std::string state_;  // identity, size and time of each file at the last read
  boost::asio::signal_set signals_;
  boost::asio::steady_timer timer_;
};

}  // namespace vat
