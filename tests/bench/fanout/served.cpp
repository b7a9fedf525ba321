#include "tests/bench/fanout/served.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace vat::bench {
namespace {

std::uint16_t port_in(const std::string& url) {
  const std::size_t scheme = url.find("http://");
  const std::size_t colon = url.find(':', scheme + 7);
  if (scheme == std::string::npos || colon == std::string::npos) {
    throw std::runtime_error("the server did not tell its URL");
  }
  return static_cast<std::uint16_t>(std::stoul(url.substr(colon + 1)));
}

struct Times {
  std::string name;
  double seconds = 0;  ///< processor time of program and system
};

/// Reads the times of a process or thread; proc(5) describes the line.
Times read_served_times(const std::filesystem::path& folder) {
  std::ifstream file(folder / "stat");
  std::string text;
  std::getline(file, text);
  const std::size_t begin = text.find('(') + 1;
  const std::size_t end = text.rfind(')');
  std::istringstream fields(text.substr(end + 1));
  std::string skipped;
  for (int i = 3; i < 14; ++i) fields >> skipped;
  double user = 0;
  double system = 0;
  fields >> user >> system;
  return {text.substr(begin, end - begin),
          (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK))};
}

std::string read_line(int file) {
  std::string line;
  for (char byte = 0; read(file, &byte, 1) == 1 && byte != '\n';) line += byte;
  return line;
}

std::string get(std::uint16_t port, const std::string& target) {
  const int file = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const std::string request =
      "GET " + target + " HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n";
  std::string reply;
  if (connect(file, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
      send(file, request.data(), request.size(), MSG_NOSIGNAL) > 0) {
    std::array<char, 4096> bytes;
    for (ssize_t got = 0; (got = recv(file, bytes.data(), bytes.size(), 0)) > 0;) {
      reply.append(bytes.data(), static_cast<std::size_t>(got));
    }
  }
  close(file);
  if (!reply.starts_with("HTTP/1.1 200")) throw std::runtime_error("the server has no " + target);
  return reply.substr(reply.find("\r\n\r\n") + 4);
}

}  // namespace

Served::Served(const std::string& program, const std::vector<std::string>& arguments,
               const std::string& log)
    : log_(log) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  std::vector<std::string> words{program, "serve", "--port", "0"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  process_ = fork();
  if (process_ == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    dup2(ends[1], STDOUT_FILENO);
    if (!log.empty()) {
      dup2(open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644), STDERR_FILENO);
    }
    execv(program.c_str(), argv.data());
    _exit(127);
  }
  close(ends[1]);
  output_ = ends[0];
  if (process_ < 0) throw std::runtime_error("no process for the server");
  port_ = port_in(read_line(output_));
}

Served::~Served() {
  kill(process_, SIGTERM);
  waitpid(process_, nullptr, 0);
  close(output_);
}

double processor_seconds_of(int process) {
  return read_served_times("/proc/" + std::to_string(process)).seconds;
}

double Served::processor_seconds() const {
  return processor_seconds_of(process_);
}

double Served::delivery_seconds() const {
  return seconds_of_thread("vat-frames") + seconds_of_thread("vat-network");
}

double Served::seconds_of_thread(const std::string& name) const {
  double seconds = 0;
  const std::string tasks = "/proc/" + std::to_string(process_) + "/task";
  for (const auto& task : std::filesystem::directory_iterator(tasks)) {
    const Times times = read_served_times(task.path());
    if (times.name == name) seconds += times.seconds;
  }
  return seconds;
}

std::uint64_t Served::resident_bytes() const {
  std::ifstream file("/proc/" + std::to_string(process_) + "/statm");
  std::uint64_t size = 0;
  std::uint64_t resident = 0;
  file >> size >> resident;
  return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

std::size_t Served::log_size() const {
  return static_cast<std::size_t>(std::filesystem::file_size(log_));
}

std::vector<TickTimes> Served::ticks_since(std::size_t begin) const {
  std::ifstream file(log_);
  file.seekg(static_cast<std::streamoff>(begin));
  std::vector<TickTimes> ticks;
  for (std::string line; std::getline(file, line);) {
    const std::size_t found = line.find(": tick ");
    TickTimes tick;
    if (found != std::string::npos &&
        std::sscanf(line.c_str() + found, ": tick %*u took %lf s, publishing %lf s, late %lf s",
                    &tick.seconds, &tick.publish, &tick.lateness) == 3) {
      ticks.push_back(tick);
    }
  }
  return ticks;
}

std::map<std::string, double> Served::metrics() const {
  std::istringstream text(get(port_, "/metrics"));
  std::map<std::string, double> samples;
  for (std::string line; std::getline(text, line);) {
    const std::size_t blank = line.rfind(' ');
    if (line.starts_with('#') || blank == std::string::npos) continue;
    samples[line.substr(0, blank)] = std::stod(line.substr(blank + 1));
  }
  return samples;
}

}  // namespace vat::bench
