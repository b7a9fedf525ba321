#include "tests/cluster/nodes.h"

#include <sys/wait.h>

#include <csignal>

#include "tests/support/pool_scene.h"
#include "tests/support/wait.h"

namespace vat::test {

Nodes::Nodes(std::size_t count, std::vector<std::string> options,
             std::map<std::string, std::size_t> threads)
    : options_(std::move(options)), threads_(std::move(threads)) {
  folder_.write("scenes/pool.json", kPoolScene);
  for (std::size_t i = 0; i < count; ++i) {
    const std::string name(1, static_cast<char>('a' + i));
    nodes_[name].port = free_port();
    start(name);
  }
}

void Nodes::start(const std::string& node) {
  const auto threads = threads_.find(node);
  const std::size_t count = threads == threads_.end() ? 2 : threads->second;
  std::string servers;
  for (const std::string& url : nats_.urls()) servers += (servers.empty() ? "" : ",") + url;
  const std::map<std::string, std::string> values{{"--cluster", servers},
                                                  {"--node", node},
                                                  {"--public-url", url(node)},
                                                  {"--port", std::to_string(nodes_.at(node).port)},
                                                  {"--data", folder_.file(node)},
                                                  {"--scenes", folder_.file("scenes")},
                                                  {"--scene", "pool"},
                                                  {"--threads", std::to_string(count)},
                                                  {"--log-level", "warn"}};
  std::vector<std::string> arguments{"serve"};
  for (const auto& [option, value] : values) arguments.insert(arguments.end(), {option, value});
  arguments.insert(arguments.end(), options_.begin(), options_.end());
  nodes_.at(node).process = nullptr;
  nodes_.at(node).process = std::make_unique<script::ServerProcess>(VAT_PROGRAM, arguments);
}

void Nodes::signal(const std::string& node, int signal) {
  const int pid = process(node).process();
  ::kill(pid, signal);
  // Some threads may run on until the kernel has stopped all of them.
  siginfo_t stopped;
  if (signal == SIGSTOP) ::waitid(P_PID, static_cast<id_t>(pid), &stopped, WSTOPPED);
}

std::string Nodes::url(const std::string& node) const {
  return "ws://127.0.0.1:" + std::to_string(nodes_.at(node).port) + "/ws";
}

std::string Nodes::node_at(const std::string& url_of_node) const {
  for (const auto& [name, node] : nodes_) {
    if (url(name) == url_of_node) return name;
  }
  throw std::runtime_error("no node has the URL " + url_of_node);
}

std::vector<std::string> Nodes::others(const std::string& node) const {
  std::vector<std::string> others;
  for (const auto& [name, other] : nodes_) {
    if (name != node) others.push_back(name);
  }
  return others;
}

WaitingClient Nodes::connect(const std::string& node) const {
  try {
    WaitingClient client(nodes_.at(node).port);
    if (client.is_connected()) return client;
  } catch (const std::runtime_error&) {
    // The node has ended, for example.
  }
  throw Gone("no connection to " + node);
}

std::string Nodes::owner_of(const std::string& session, const std::string& asked,
                            const std::string& before) const {
  WaitingClient client = connect(asked);
  std::string owner;
  const bool is_known = wait_until([&] {
    const Json listed = client.result("session.list");
    for (const Json& one : listed.at("sessions")) {
      if (one.at("session") == session) owner = one.value("node", "");
    }
    return !owner.empty() && owner != before;
  });
  if (!is_known) throw std::runtime_error(session + " has no owner");
  return owner;
}

Nodes::Joined Nodes::join(const std::string& session, const std::string& node,
                          const Json& params) const {
  Json request = params;
  request["session"] = session;
  std::optional<Joined> joined;
  std::string at = node;
  // A node may name an owner that has failed until its silence is noticed.
  const bool has_joined = wait_until([&] {
    try {
      WaitingClient client = connect(at);
      const Json reply = client.call("session.join", request);
      if (reply.contains("result")) {
        joined.emplace(Joined{std::move(client), reply.at("result"), at});
        return true;
      }
      const Json error = reply.at("error").at("data");
      if (error.at("kind") == "storage_failed") return false;
      if (error.at("kind") != "moved") throw std::runtime_error(reply.dump());
      const std::string to = error.at("url");
      at = to.empty() ? node : node_at(to);
    } catch (const Gone&) {
      at = node;
    }
    return false;
  });
  if (!has_joined) throw std::runtime_error("no node lets a client join " + session);
  return *std::move(joined);
}

}  // namespace vat::test
