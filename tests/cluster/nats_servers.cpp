#include "tests/cluster/nats_servers.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <utility>

#include "tests/support/wait.h"

namespace vat::test {
namespace {

constexpr int kAttempts = 5;  // another process may take a free port before the server does

sockaddr_in loopback(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

bool accepts(std::uint16_t port) {
  const int handle = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address = loopback(port);
  const bool connected =
      connect(handle, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
  close(handle);
  return connected;
}

bool has_ended(int pid) {
  return waitpid(pid, nullptr, WNOHANG) != 0;
}

}  // namespace

std::uint16_t free_port() {
  const int handle = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address = loopback(0);
  socklen_t size = sizeof address;
  auto* const any = reinterpret_cast<sockaddr*>(&address);
  const bool is_bound = bind(handle, any, size) == 0 && getsockname(handle, any, &size) == 0;
  close(handle);
  if (!is_bound) throw std::runtime_error("no free port");
  return ntohs(address.sin_port);
}

NatsServers::NatsServers(std::size_t count, std::string config)
    : config_(std::move(config)), servers_(count) {
  for (int attempt = 1;; ++attempt) {
    for (Server& server : servers_) {
      server.port = free_port();
      server.route_port = free_port();
    }
    try {
      for (std::size_t i = 0; i < count; ++i) start(i);
      return;
    } catch (const std::runtime_error&) {
      stop_all();
      if (attempt == kAttempts) throw;
    }
  }
}

NatsServers::~NatsServers() {
  stop_all();
}

void NatsServers::stop_all() {
  for (std::size_t i = 0; i < servers_.size(); ++i) kill(i);
}

std::vector<std::string> NatsServers::urls() const {
  std::vector<std::string> urls;
  for (const Server& server : servers_) {
    urls.push_back("nats://127.0.0.1:" + std::to_string(server.port));
  }
  return urls;
}

void NatsServers::kill(std::size_t index) {
  Server& server = servers_.at(index);
  if (server.pid < 0) return;
  ::kill(server.pid, SIGKILL);
  waitpid(server.pid, nullptr, 0);
  server.pid = -1;
}

void NatsServers::restart(std::size_t index) {
  start(index);
}

void NatsServers::start(std::size_t index) {
  Server& server = servers_.at(index);
  const std::string name = "nats" + std::to_string(index);
  std::string config = "server_name: " + name +
                       "\nlisten: \"127.0.0.1:" + std::to_string(server.port) +
                       "\"\njetstream { store_dir: \"" + folder_.file(name) + "\" }\n" + config_;
  if (servers_.size() > 1) {
    config +=
        "cluster {\n  name: test\n  listen: \"127.0.0.1:" + std::to_string(server.route_port) +
        "\"\n  routes: [\n";
    for (const Server& other : servers_) {
      config += "    \"nats://127.0.0.1:" + std::to_string(other.route_port) + "\"\n";
    }
    config += "  ]\n}\n";
  }
  folder_.write(name + ".conf", config);
  const std::string file = folder_.file(name + ".conf");
  const std::string log = folder_.file(name + ".log");
  server.pid = fork();
  if (server.pid == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    const int output = open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
    dup2(output, STDOUT_FILENO);
    dup2(output, STDERR_FILENO);
    execlp("nats-server", "nats-server", "-c", file.c_str(), nullptr);
    // The package installs to a folder that users may not search.
    execl("/usr/sbin/nats-server", "nats-server", "-c", file.c_str(), nullptr);
    _exit(127);
  }
  bool ended = false;
  const bool ready =
      wait_until([&] { return (ended = has_ended(server.pid)) || accepts(server.port); });
  if (ended) server.pid = -1;
  if (ended || !ready) throw std::runtime_error(name + " did not start");
}

}  // namespace vat::test
