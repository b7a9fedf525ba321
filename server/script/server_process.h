#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

namespace vat::script {

/// A running `vat serve`, which ends when this is destroyed.
class ServerProcess {
 public:
  /// Starts `program` with `arguments` and waits for its URL. Throws std::runtime_error if the
  /// program prints no URL.
  ServerProcess(const std::string& program, const std::vector<std::string>& arguments);
  ~ServerProcess();
  ServerProcess(const ServerProcess&) = delete;
  ServerProcess& operator=(const ServerProcess&) = delete;

  std::uint16_t port() const { return port_; }
  /// Whether its port uses TLS.
  bool is_secure() const { return is_secure_; }
  bool is_running();
  /// Process id.
  int process() const { return pid_; }
  /// Sends SIGKILL.
  void kill();
  /// Sends SIGTERM and returns the exit status. Throws if the process does not end in ten seconds,
  /// or ends by a signal.
  int stop();

 private:
  void start(const std::string& program, const std::vector<std::string>& arguments);
  std::string read_line(std::chrono::steady_clock::time_point deadline);
  /// Whether the process has ended; stores its status.
  bool reap();

  int pid_ = -1;  ///< -1: none
  int output_ = -1;
  int status_ = 0;
  std::uint16_t port_ = 0;
  bool is_secure_ = false;
};

}  // namespace vat::script
