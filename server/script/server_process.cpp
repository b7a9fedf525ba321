#include "server/script/server_process.h"

#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <thread>

namespace vat::script {
namespace {

using std::chrono::steady_clock;

constexpr auto kStartTime = std::chrono::seconds(30);  // a sanitizer build on a busy machine
constexpr auto kStopTime = std::chrono::seconds(60);   // of a sanitizer build

/// In "vat is at http://HOST:PORT/ ...", the line that the server prints when it is ready.
struct Place {
  bool is_secure;
  std::uint16_t port;
};

std::optional<Place> place_in(const std::string& line) {
  constexpr std::string_view kStart = "vat is at http";
  if (!line.starts_with(kStart)) return {};
  const std::size_t host = line.find("://") + 3;
  const std::size_t colon = line.rfind(':', line.find('/', host));
  return Place{line[kStart.size()] == 's',
               static_cast<std::uint16_t>(std::stoul(line.substr(colon + 1)))};
}

}  // namespace

ServerProcess::ServerProcess(const std::string& program,
                             const std::vector<std::string>& arguments) {
  start(program, arguments);
  const auto deadline = steady_clock::now() + kStartTime;
  try {
    std::optional<Place> place;
    while (!place) place = place_in(read_line(deadline));
    port_ = place->port;
    is_secure_ = place->is_secure;
  } catch (...) {
    if (!reap()) {
      ::kill(pid_, SIGKILL);
      waitpid(pid_, nullptr, 0);
    }
    close(output_);
    throw;
  }
}

ServerProcess::~ServerProcess() {
  kill();
  close(output_);
}

void ServerProcess::kill() {
  if (reap()) return;
  ::kill(pid_, SIGKILL);
  waitpid(pid_, &status_, 0);
  pid_ = -1;
}

void ServerProcess::start(const std::string& program, const std::vector<std::string>& arguments) {
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("no pipe for the server's output");
  std::vector<std::string> words{program};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  argv.reserve(words.size() + 1);
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  pid_ = fork();
  if (pid_ == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);  // a server must not outlive a runner that crashed
    dup2(ends[1], STDOUT_FILENO);
    close(ends[0]);
    close(ends[1]);
    execv(program.c_str(), argv.data());
    _exit(127);
  }
  close(ends[1]);
  output_ = ends[0];
  if (pid_ < 0) {
    close(output_);
    throw std::runtime_error("no process for the server");
  }
}

std::string ServerProcess::read_line(steady_clock::time_point deadline) {
  std::string line;
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - steady_clock::now());
    pollfd ready{output_, POLLIN, 0};
    if (left.count() <= 0 || poll(&ready, 1, static_cast<int>(left.count())) <= 0) {
      throw std::runtime_error("the server did not print its URL in time; last line: " + line);
    }
    char byte = 0;
    if (::read(output_, &byte, 1) != 1) {
      throw std::runtime_error("the server ended before it printed its URL; last line: " + line);
    }
    if (byte == '\n') return line;
    line += byte;
  }
}

bool ServerProcess::reap() {
  if (pid_ < 0) return true;
  if (waitpid(pid_, &status_, WNOHANG) == 0) return false;
  pid_ = -1;
  return true;
}

bool ServerProcess::is_running() {
  return !reap();
}

int ServerProcess::stop() {
  if (!reap()) ::kill(pid_, SIGTERM);
  const auto deadline = steady_clock::now() + kStopTime;
  while (!reap()) {
    if (steady_clock::now() > deadline) {
      throw std::runtime_error("the server did not end within a minute after SIGTERM");
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  if (!WIFEXITED(status_)) {
    throw std::runtime_error("the server was ended by signal " + std::to_string(WTERMSIG(status_)));
  }
  return WEXITSTATUS(status_);
}

}  // namespace vat::script
