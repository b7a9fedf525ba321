#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

namespace vat::script {

/// A running process `vat serve`. The destructor ends the process.
class ServerProcess {
 public:
  /// Starts `program` with `arguments` and waits until it prints its URL. Throws std::runtime_error
  /// if the program prints no URL.
  ServerProcess(const std::string& program, const std::vector<std::string>& arguments);
  ~ServerProcess();
  ServerProcess(const ServerProcess&) = delete;
  ServerProcess& operator=(const ServerProcess&) = delete;

  std::uint16_t port() const { return port_; }
  /// Returns whether the port uses TLS.
  bool is_secure() const { return is_secure_; }
  bool is_running();
  /// Returns the process id.
  int process() const { return pid_; }
  /// Sends SIGKILL.
  void kill();
  /// Sends SIGTERM and returns the exit status. Throws std::runtime_error if the process does not
  /// end within 60 s or is ended by a signal.
  int stop();

 private:
  void start(const std::string& program, const std::vector<std::string>& arguments);
  std::string read_line(std::chrono::steady_clock::time_point deadline);
  /// Returns whether the process has ended, and stores the exit status.
  bool reap();

  int pid_ = -1;  ///< -1: no process
  int output_ = -1;
  int status_ = 0;
  std::uint16_t port_ = 0;
  bool is_secure_ = false;
};

}  // namespace vat::script
