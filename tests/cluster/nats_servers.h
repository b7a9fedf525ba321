#pragma once

#include <cstddef>
#include <cstdint>

#include "tests/support/temporary_folder.h"

namespace vat::test {

/// Returns a port of the loopback interface that was unused a moment ago.
std::uint16_t free_port();

/// Running processes `nats-server` with JetStream on the loopback interface. More than one process
/// form a group. The destructor ends them.
class NatsServers {
 public:
  /// Starts the processes and waits until their ports accept. `config` is a further part of their
  /// configuration. Throws std::runtime_error.
  explicit NatsServers(std::size_t count, std::string config = {});
  ~NatsServers();
  NatsServers(const NatsServers&) = delete;
  NatsServers& operator=(const NatsServers&) = delete;

  std::vector<std::string> urls() const;
  std::size_t size() const { return servers_.size(); }
  int process(std::size_t index) const { return servers_.at(index).pid; }
  /// Sends SIGKILL to a process, and waits for its end.
  void kill(std::size_t index);
  /// Starts a killed process again, with its data.
  void restart(std::size_t index);

 private:
  struct Server {
    int pid = -1;  ///< -1: no process
    std::uint16_t port = 0;
    std::uint16_t route_port = 0;
  };
  void start(std::size_t index);
  void stop_all();

  TemporaryFolder folder_;
  const std::string config_;
  std::vector<Server> servers_;
};

}  // namespace vat::test
