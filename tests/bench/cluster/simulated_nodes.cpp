#include "tests/bench/cluster/simulated_nodes.h"

#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <stdexcept>

#include "server/cluster/cluster_node.h"
#include "server/operations/log_format.h"
#include "server/storage/storage.h"
#include "tests/bench/cluster/slow_clock.h"

namespace vat::bench {
namespace {

constexpr char kNodesReady = 'r';
constexpr char kCreateSessions = 'c';
constexpr char kTellCounts = 't';
constexpr int kLook = 20;                // [ms] between looks at the leases
constexpr int kNodesPatience = 600'000;  // [ms]
constexpr double kCoresOfNode = 8;

/// A node, its storage, and a host that only counts.
class SimulatedNode final : public ClusterHost {
 public:
  SimulatedNode(const SimulatedNodesSettings& settings, const std::string& name)
      : clock_(settings.slow_motion),
        storage_(settings.folder / name, {}, clock_),
        node_(
            [&] {
              ClusterSettings cluster;
              cluster.servers = settings.servers;
              cluster.node = name;
              cluster.public_url = "ws://" + name + "/ws";
              cluster.entry_life =
                  Lease::kOthersTime * static_cast<int>(std::ceil(settings.slow_motion));
              return cluster;
            }(),
            storage_, clock_, kCoresOfNode, "simulated") {
    node_.start(*this);
  }
  ~SimulatedNode() override { node_.stop(); }

  void create_session() {
    node_.add_session({}, to_string(InstructionSet::baseline), "{}",
                      {1, 0, 0, 0, "session.create", "{}"});
  }
  void look_at_lease() {
    if (was_open_ && !node_.is_open()) ++lapses_;
    was_open_ = node_.is_open();
  }
  void add_to(SimulatedNodesCounts& counts) const {
    counts.taken += taken_;
    counts.lost += lost_;
    counts.lapses += lapses_;
  }

  void start_taken(const StoredSession&) override { ++taken_; }
  void end_lost(std::uint64_t, const std::string&, std::function<void()> done) override {
    ++lost_;
    done();
  }
  bool stop_for_move(std::uint64_t, std::function<void()>) override { return false; }
  void create_for(const std::string&, std::function<void(const std::string&)> answer) override {
    answer("{}");
  }
  void cluster_changed() override {}

 private:
  SlowClock clock_;
  Storage storage_;
  std::atomic<std::uint64_t> taken_ = 0;
  std::atomic<std::uint64_t> lost_ = 0;
  std::uint64_t lapses_ = 0;
  bool was_open_ = false;
  ClusterNode node_;
};

void put_all(int file, const void* data, std::size_t size) {
  if (write(file, data, size) != static_cast<ssize_t>(size)) {
    throw std::runtime_error("the pipe to the benchmark has broken");
  }
}

void run_nodes(const SimulatedNodesSettings& settings, const std::vector<std::string>& names,
               int from, int to) {
  std::vector<std::unique_ptr<SimulatedNode>> nodes;
  for (const std::string& name : names) {
    nodes.push_back(std::make_unique<SimulatedNode>(settings, name));
  }
  put_all(to, &kNodesReady, 1);
  for (;;) {
    for (const auto& node : nodes) node->look_at_lease();
    pollfd ready{from, POLLIN, 0};
    if (poll(&ready, 1, kLook) <= 0) continue;
    char command = 0;
    if (::read(from, &command, 1) != 1) return;
    if (command == kCreateSessions) {
      for (std::size_t i = 0; i < settings.sessions; ++i) {
        for (const auto& node : nodes) node->create_session();
      }
      put_all(to, &kNodesReady, 1);
    } else if (command == kTellCounts) {
      SimulatedNodesCounts counts;
      for (const auto& node : nodes) node->add_to(counts);
      put_all(to, &counts, sizeof counts);
    }
  }
}

}  // namespace

SimulatedNodes::SimulatedNodes(const SimulatedNodesSettings& settings) {
  for (std::size_t i = 0; i < settings.count; ++i) {
    names_.push_back("n" + std::to_string(settings.first + i));
  }
  std::array<int, 2> to{};
  std::array<int, 2> from{};
  if (pipe(to.data()) != 0 || pipe(from.data()) != 0) throw std::runtime_error("no pipe");
  process_ = fork();
  if (process_ < 0) throw std::runtime_error("no process for the nodes");
  if (process_ == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    close(to[1]);
    close(from[0]);
    int status = 0;
    try {
      start_log("error", false);
      // The connections of the process share the thread that delivers messages.
      setenv("NATS_DEFAULT_TO_LIB_MSG_DELIVERY", "1", 1);
      run_nodes(settings, names_, to[0], from[1]);
    } catch (const std::exception& error) {
      std::cerr << "simulated nodes: " << error.what() << '\n';
      status = 1;
    }
    _exit(status);
  }
  close(to[0]);
  close(from[1]);
  to_ = to[1];
  from_ = from[0];
}

SimulatedNodes::~SimulatedNodes() {
  kill();
  close(to_);
  close(from_);
}

void SimulatedNodes::kill() {
  if (process_ < 0) return;
  ::kill(process_, SIGKILL);
  waitpid(process_, nullptr, 0);
  process_ = -1;
}

void SimulatedNodes::wait_ready() {
  char answer = 0;
  read(&answer, 1);
}

void SimulatedNodes::create_sessions() {
  ask(kCreateSessions);
  wait_ready();
}

SimulatedNodesCounts SimulatedNodes::counts() {
  ask(kTellCounts);
  SimulatedNodesCounts counts;
  read(&counts, sizeof counts);
  return counts;
}

void SimulatedNodes::ask(char command) {
  if (write(to_, &command, 1) != 1) throw std::runtime_error("the nodes have ended early");
}

void SimulatedNodes::read(void* data, std::size_t size) {
  pollfd ready{from_, POLLIN, 0};
  if (poll(&ready, 1, kNodesPatience) <= 0) throw std::runtime_error("the nodes do not answer");
  // The process writes at most a few bytes at once, which a pipe does not divide.
  if (::read(from_, data, size) != static_cast<ssize_t>(size)) {
    throw std::runtime_error("the nodes have ended early");
  }
}

}  // namespace vat::bench
