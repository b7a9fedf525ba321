#include "tests/bench/cluster/cluster.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <filesystem>
#include <future>
#include <iostream>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "protocol/frame/frame_codec.h"
#include "server/cli/common/command.h"
#include "tests/bench/cluster/cluster_nodes.h"
#include "tests/bench/report/table.h"
#include "tests/bench/soak/caller.h"
#include "tests/bench/speed/machine.h"

namespace vat::bench {
namespace {

using std::chrono::steady_clock;
using ClusterSeconds = std::chrono::duration<double>;

struct ClusterOptions {
  std::string scene = "sliding-vat-liquid";
  std::size_t kills = 20;
  std::size_t moves = 6;
  std::string program = VAT_PROGRAM;
  std::string output = VAT_SOURCE_DIR "/build/bench/cluster";
};

constexpr double kMaxMedianFailOver = 4;  // [s]
constexpr double kMaxFailOver = 5;        // of 95 % [s]
constexpr double kMaxHandOver = 1;        // [s]
constexpr std::chrono::seconds kPlayTime{1};
constexpr std::chrono::milliseconds kRetryTime(50);
constexpr std::chrono::minutes kClusterPatience{1};

/// A viewer that follows the session "s1", with a command between its frames.
class ClusterViewer {
 public:
  explicit ClusterViewer(ClusterNodes& nodes) : nodes_(nodes) {}

  std::size_t node() const { return node_; }
  std::size_t commands() const { return commands_; }
  steady_clock::time_point last_frame() const { return last_frame_; }

  /// Joins at the first node that lets it, beginning with `node`, and waits for a frame.
  void join(std::size_t node) {
    const auto deadline = steady_clock::now() + kClusterPatience;
    while (!try_join(node)) {
      if (steady_clock::now() > deadline) throw std::runtime_error("no node has the session");
      std::this_thread::sleep_for(kRetryTime);
    }
    call("frames.subscribe", Json::object());
    const auto before = last_frame_;
    while (last_frame_ == before) read(deadline);
  }
  /// Sends commands and watches for the time. Returns early if the session moves.
  void play(std::chrono::milliseconds time) {
    const auto end = steady_clock::now() + time;
    while (steady_clock::now() < end && !is_moved_) {
      const double g = -9 - 1e-3 * static_cast<double>(++commands_ % 100);
      call("world.set_gravity", {{"gravity", {0, 0, g}}});
    }
  }
  /// Reads until the session moves, and returns the node that it moves to.
  std::size_t wait_for_move() {
    const auto deadline = steady_clock::now() + kClusterPatience;
    while (!is_moved_) read(deadline);
    return nodes_.node_at(moved_to_);
  }

 private:
  bool try_join(std::size_t& node) {
    is_moved_ = false;
    try {
      connection_ = connect(nodes_.port(node));
      Json params{{"session", "s1"}};
      if (!resume_.empty()) params["resume"] = resume_;
      const Json reply = send("session.join", params);
      if (reply.contains("result")) {
        const Json& joined = reply.at("result");
        if (!resume_.empty() && joined.at("resumed") != true) {
          throw std::logic_error("the participant was lost");
        }
        resume_ = joined.at("resume");
        node_ = node;
        return true;
      }
      const std::string to = reply.at("error").at("data").value("url", "");
      if (!to.empty()) node = nodes_.node_at(to);
    } catch (const std::runtime_error&) {  // the node has ended
      node = (node + 1) % nodes_.size();
    }
    return false;
  }
  void call(const std::string& method, const Json& params) {
    const Json reply = send(method, params);
    if (!is_moved_ && !reply.contains("result")) throw std::runtime_error(reply.dump());
  }
  Json send(const std::string& method, const Json& params) {
    connection_->send_text(
        Json{{"jsonrpc", "2.0"}, {"id", ++id_}, {"method", method}, {"params", params}}.dump());
    const auto deadline = steady_clock::now() + kClusterPatience;
    for (;;) {
      const auto reply = read(deadline);
      if (is_moved_ || (reply && reply->value("id", Json()) == id_)) return reply.value_or(Json());
    }
  }
  /// Reads a message. Acknowledges a frame, and returns a text.
  std::optional<Json> read(steady_clock::time_point deadline) {
    const auto message = connection_->next(deadline);
    if (!message || message->kind == client::Message::Kind::closed) {
      throw std::runtime_error("the connection has ended");
    }
    if (message->kind == client::Message::Kind::text) {
      Json text = Json::parse(message->bytes);
      if (text.value("method", "") == "session.moved") {
        is_moved_ = true;
        moved_to_ = text.at("params").at("url");
      }
      return text;
    }
    last_frame_ = steady_clock::now();
    const std::span bytes(reinterpret_cast<const std::uint8_t*>(message->bytes.data()),
                          message->bytes.size());
    connection_->send_text(Json{
        {"jsonrpc", "2.0"}, {"method", "frames.ack"}, {"params", {{"number", frame_number(bytes)}}}}
                               .dump());
    return {};
  }

  ClusterNodes& nodes_;
  std::unique_ptr<client::Connection> connection_;
  std::size_t node_ = 0;
  std::size_t commands_ = 0;
  std::int64_t id_ = 0;
  std::string resume_;
  std::string moved_to_;
  bool is_moved_ = false;
  steady_clock::time_point last_frame_{};
};

double seconds_between(steady_clock::time_point begin, steady_clock::time_point end) {
  return ClusterSeconds(end - begin).count();
}

double quantile_of(std::vector<double> times, double part) {
  if (times.empty()) return kAbsent;
  std::ranges::sort(times);
  const auto index = static_cast<std::size_t>(part * static_cast<double>(times.size() - 1) + 0.5);
  return times[index];
}

int measure_cluster(const ClusterOptions& options) {
  ClusterNodes nodes(options.program, std::filesystem::absolute(options.output) / "data",
                     options.scene);
  ClusterViewer viewer(nodes);
  viewer.join(0);
  std::vector<double> kills;
  std::vector<double> moves;
  for (std::size_t i = 0; i < options.kills; ++i) {
    viewer.play(kPlayTime);
    const std::size_t node = viewer.node();
    nodes.kill(node);
    const auto begin = steady_clock::now();
    viewer.join((node + 1) % nodes.size());
    kills.push_back(seconds_between(begin, viewer.last_frame()));
    std::cout << "kill " << i + 1 << ": frames after " << kills.back() << " s" << std::endl;
    nodes.start(node);
  }
  for (std::size_t i = 0; i < options.moves; ++i) {
    viewer.play(kPlayTime);
    const std::size_t node = viewer.node();
    // The destructor of the future waits, also after an exception.
    const auto stop = std::async(std::launch::async, [&] { nodes.stop(node); });
    const std::size_t next = viewer.wait_for_move();
    const auto begin = viewer.last_frame();
    viewer.join(next);
    moves.push_back(seconds_between(begin, viewer.last_frame()));
    std::cout << "stop " << i + 1 << ": no frames for " << moves.back() << " s" << std::endl;
    stop.wait();
    nodes.start(node);
  }
  const bool passed = quantile_of(kills, 0.5) <= kMaxMedianFailOver &&
                      quantile_of(kills, 0.95) <= kMaxFailOver &&
                      quantile_of(moves, 1) <= kMaxHandOver;
  const Machine machine = this_machine();
  const Table table{
      {"scene", "kills", "commands", "median fail-over [s]", "95 % fail-over [s]", "hand-overs",
       "median hand-over [s]", "longest hand-over [s]", "passed", "commit", "cpu", "cores"},
      {{options.scene, std::uint64_t{kills.size()}, std::uint64_t{viewer.commands()},
        quantile_of(kills, 0.5), quantile_of(kills, 0.95), std::uint64_t{moves.size()},
        quantile_of(moves, 0.5), quantile_of(moves, 1), passed, machine.commit, machine.cpu,
        std::uint64_t{machine.cores}}}};
  std::cout << to_markdown(table);
  if (const Status status = write_table(table, options.output, "cluster", "# Cluster"); !status) {
    return fail(options.output, status.errors());
  }
  return passed ? kExitOk : kExitFailed;
}

int run_cluster(const ClusterOptions& options) {
  try {
    return measure_cluster(options);
  } catch (const std::exception& error) {
    std::cerr << "cluster: " << error.what() << '\n';
    return kExitFailed;
  }
}

}  // namespace

void add_cluster_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("cluster", "Fail-over and hand-over of a session");
  const auto options = std::make_shared<ClusterOptions>();
  command->add_option("--scene", options->scene, "Scene of the session")->capture_default_str();
  command->add_option("--kills", options->kills, "Kills of the session's node")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--moves", options->moves, "Stops of the session's node by SIGTERM")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--program", options->program, "Program of the server")
      ->capture_default_str();
  command->add_option("--output", options->output, "Folder of the results and the nodes' data")
      ->capture_default_str();
  command->footer(
      "Exit codes: 0 the bounds hold, 1 a bound is exceeded or the cluster failed, "
      "2 wrong usage.");
  command->callback([options, &exit_code] { exit_code = run_cluster(*options); });
}

}  // namespace vat::bench
