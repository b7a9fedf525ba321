#include "tests/bench/fanout/load.h"

#include <poll.h>
#include <sys/epoll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <iostream>
#include <memory>
#include <stdexcept>

namespace vat::bench {
namespace {

constexpr int kPatience = 60'000;  // [ms]
constexpr char kReady = 'r';
constexpr char kBegin = 'b';
constexpr char kTell = 't';
constexpr char kEnd = 'e';

void write_all(int file, const void* data, std::size_t size) {
  const auto* bytes = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t written = write(file, bytes, size);
    if (written <= 0) throw std::runtime_error("a pipe of the load has broken");
    bytes += written;
    size -= static_cast<std::size_t>(written);
  }
}

void read_all(int file, void* data, std::size_t size) {
  auto* bytes = static_cast<char*>(data);
  while (size > 0) {
    const ssize_t got = read(file, bytes, size);
    if (got <= 0) throw std::runtime_error("the load has ended early");
    bytes += got;
    size -= static_cast<std::size_t>(got);
  }
}

void write_numbers(int file, const std::vector<float>& numbers) {
  const std::uint64_t count = numbers.size();
  write_all(file, &count, sizeof count);
  write_all(file, numbers.data(), count * sizeof(float));
}

std::vector<float> read_numbers(int file) {
  std::uint64_t count = 0;
  read_all(file, &count, sizeof count);
  std::vector<float> numbers(count);
  read_all(file, numbers.data(), count * sizeof(float));
  return numbers;
}

void write_sightings(int file, const Sightings& seen) {
  for (const std::uint64_t count : {seen.frames, seen.bytes, seen.joins, seen.closed}) {
    write_all(file, &count, sizeof count);
  }
  write_numbers(file, seen.ages);
  write_numbers(file, seen.first_frames);
}

Sightings read_sightings(int file) {
  Sightings seen;
  for (std::uint64_t* count : {&seen.frames, &seen.bytes, &seen.joins, &seen.closed}) {
    read_all(file, count, sizeof *count);
  }
  seen.ages = read_numbers(file);
  seen.first_frames = read_numbers(file);
  return seen;
}

/// The load process.
class Load {
 public:
  Load(const LoadSettings& settings, const ViewerCounts& counts, std::uint32_t seed, int from,
       int to)
      : from_(from), to_(to), events_(epoll_create1(EPOLL_CLOEXEC)) {
    for (std::size_t kind = 0; kind < kViewerKinds; ++kind) {
      for (std::size_t i = 0; i < counts[kind]; ++i) {
        viewers_.push_back(
            std::make_unique<Viewer>(static_cast<ViewerKind>(kind), settings, ++seed));
      }
    }
  }

  void run() {
    watch(from_, EPOLLIN, kNobody, EPOLL_CTL_ADD);
    bool is_ready = false;
    for (;;) {
      connect_some();
      wait_and_read();
      look_at_clock();
      if (!is_ready && all_have_frames()) {
        is_ready = true;
        write_all(to_, &kReady, 1);
      }
      if (command_ == kBegin) seen_ = {};
      if (command_ == kTell || command_ == kEnd) {
        for (const Sightings& seen : seen_) write_sightings(to_, seen);
      }
      if (command_ == kEnd) break;
      command_ = 0;
    }
  }

 private:
  static constexpr std::size_t kNobody = ~std::size_t{0};
  static constexpr std::size_t kConnectsPerTurn = 4;

  void watch(int file, std::uint32_t events, std::size_t viewer, int operation) {
    epoll_event event{};
    event.events = events;
    event.data.u64 = viewer;
    epoll_ctl(events_, operation, file, &event);
  }
  Sightings& sightings(const Viewer& viewer) {
    return seen_[static_cast<std::size_t>(viewer.kind())];
  }
  void connect_some() {
    for (std::size_t i = 0; i < kConnectsPerTurn && connected_ < viewers_.size(); ++i) {
      viewers_[connected_]->connect();
      watch(viewers_[connected_]->socket(), EPOLLIN, connected_, EPOLL_CTL_ADD);
      ++connected_;
    }
  }
  void wait_and_read() {
    std::array<epoll_event, 256> ready;
    const int count = epoll_wait(events_, ready.data(), static_cast<int>(ready.size()), 2);
    for (int e = 0; e < count; ++e) {
      const std::size_t index = ready[static_cast<std::size_t>(e)].data.u64;
      if (index == kNobody) {
        read_all(from_, &command_, 1);
        continue;
      }
      Viewer& viewer = *viewers_[index];
      if (!viewer.read(sightings(viewer)) && viewer.socket() >= 0) {
        watch(viewer.socket(), 0, index, EPOLL_CTL_MOD);
      }
    }
  }
  void look_at_clock() {
    const auto now = LoadClock::now();
    if (now < next_look_) return;
    next_look_ = now + std::chrono::milliseconds(5);
    for (std::size_t i = 0; i < connected_; ++i) {
      Viewer& viewer = *viewers_[i];
      const int before = viewer.socket();
      const ViewerKind kind = viewer.kind();
      const bool needs_clock =
          kind == ViewerKind::half || kind == ViewerKind::restless || kind == ViewerKind::reader;
      if (!needs_clock) continue;
      if (!viewer.look_at_clock(now, sightings(viewer))) continue;
      // A new socket, possibly with the same number, is not in the poll set yet.
      const bool is_new = viewer.kind() == ViewerKind::restless || before != viewer.socket();
      if (viewer.socket() >= 0) {
        watch(viewer.socket(), EPOLLIN, i, is_new ? EPOLL_CTL_ADD : EPOLL_CTL_MOD);
      }
    }
  }
  bool all_have_frames() {
    if (connected_ < viewers_.size()) return false;
    while (framed_ < viewers_.size() &&
           (viewers_[framed_]->has_frame() || viewers_[framed_]->kind() == ViewerKind::restless)) {
      ++framed_;
    }
    return framed_ == viewers_.size();
  }

  const int from_;
  const int to_;
  const int events_;
  std::vector<std::unique_ptr<Viewer>> viewers_;
  std::size_t connected_ = 0;
  std::size_t framed_ = 0;  // number of viewers that have received a frame
  LoadSightings seen_;
  LoadClock::time_point next_look_;
  char command_ = 0;
};

}  // namespace

LoadProcess::LoadProcess(const LoadSettings& settings, const ViewerCounts& viewers,
                         std::uint32_t seed) {
  std::array<int, 2> to{};
  std::array<int, 2> from{};
  if (pipe(to.data()) != 0 || pipe(from.data()) != 0) throw std::runtime_error("no pipe");
  process_ = fork();
  if (process_ < 0) throw std::runtime_error("no process for the load");
  if (process_ == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    setpriority(PRIO_PROCESS, 0, settings.niceness);
    close(to[1]);
    close(from[0]);
    try {
      Load(settings, viewers, seed, to[0], from[1]).run();
      _exit(0);
    } catch (const std::exception& error) {
      std::cerr << "load: " << error.what() << std::endl;
    }
    _exit(1);
  }
  close(to[0]);
  close(from[1]);
  to_ = to[1];
  from_ = from[0];
}

LoadProcess::~LoadProcess() {
  kill(process_, SIGKILL);
  waitpid(process_, nullptr, 0);
  close(to_);
  close(from_);
}

void LoadProcess::wait_ready() {
  pollfd ready{from_, POLLIN, 0};
  char signal = 0;
  if (poll(&ready, 1, kPatience) <= 0) {
    throw std::runtime_error("not every viewer has got a frame within a minute");
  }
  read_all(from_, &signal, 1);
}

void LoadProcess::begin() {
  write_all(to_, &kBegin, 1);
}

LoadSightings LoadProcess::ask(char command) {
  write_all(to_, &command, 1);
  LoadSightings seen;
  for (Sightings& one : seen) one = read_sightings(from_);
  return seen;
}

LoadSightings LoadProcess::tell() {
  return ask(kTell);
}

LoadSightings LoadProcess::end() {
  return ask(kEnd);
}

}  // namespace vat::bench
