#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

namespace vat::script {

/// A running `vat serve`. Ends it when destroyed, in any case.
class ServerProcess {
 public:
  /// Starts `program` with `arguments` and waits for the line that names its URL. Throws
  /// std::runtime_error where it does not come.
  ServerProcess(const std::string& program, const std::vector<std::string>& arguments);
  ~ServerProcess();
  ServerProcess(const ServerProcess&) = delete;
  ServerProcess& operator=(const ServerProcess&) = delete;

  std::uint16_t port() const { return port_; }
  /// Whether its port speaks TLS.
  bool is_secure() const { return is_secure_; }
  bool is_running();
  /// Its number in the system.
  int process() const { return pid_; }
  /// Ends it at once, as no program can prevent.
  void kill();
  /// Sends SIGTERM and gives the exit status; throws where it does not end in ten seconds or ends
  /// by a signal.
  int stop();

 private:
  void start(const std::string& program, const std::vector<std::string>& arguments);
  std::string read_line(std::chrono::steady_clock::time_point deadline);
  /// Whether the process has ended; keeps its status.
  bool reap();

  int pid_ = -1;  ///< -1: there is none
  int output_ = -1;
  int status_ = 0;
  std::uint16_t port_ = 0;
  bool is_secure_ = false;
};

}  // namespace vat::script
