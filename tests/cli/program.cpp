#include "tests/cli/program.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "tests/support/wait.h"

namespace vat::test {

namespace {

pid_t start(std::vector<std::string> words, const std::string& out, const std::string& err) {
  std::vector<char*> argv;
  argv.reserve(words.size() + 1);
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  constexpr int kCreate = O_WRONLY | O_CREAT | O_TRUNC;
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out.c_str(), kCreate, 0600);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err.c_str(), kCreate, 0600);
  pid_t pid = -1;
  const int failed = posix_spawn(&pid, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) throw std::runtime_error("cannot start " + words[0]);
  return pid;
}

int wait_for(pid_t pid) {
  int status = 0;
  if (waitpid(pid, &status, 0) != pid) throw std::runtime_error("the program is lost");
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::vector<std::string> vat_words(const std::vector<std::string>& arguments) {
  std::vector<std::string> words = {VAT_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return words;
}

}  // namespace

ProgramResult run_vat(const std::vector<std::string>& arguments) {
  return RunningProgram(arguments).finish();
}

ProgramResult run_bench(const std::vector<std::string>& arguments) {
  std::vector<std::string> words = {VAT_BENCH_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  const TemporaryFolder folder;
  const int exit_code = wait_for(start(words, folder.file("out"), folder.file("err")));
  return {exit_code, read_file(folder.file("out")), read_file(folder.file("err"))};
}

ProgramResult run_vat_with_file_limit(int blocks, const std::vector<std::string>& arguments) {
  // Without the trap, the system would kill the program instead of failing its writes.
  const std::string script = "trap '' XFSZ; ulimit -f " + std::to_string(blocks) + "; exec \"$@\"";
  std::vector<std::string> words = {"/bin/sh", "-c", script, "sh"};
  const std::vector<std::string> vat = vat_words(arguments);
  words.insert(words.end(), vat.begin(), vat.end());
  const TemporaryFolder folder;
  const int exit_code = wait_for(start(words, folder.file("out"), folder.file("err")));
  return {exit_code, read_file(folder.file("out")), read_file(folder.file("err"))};
}

// Opened for writing too, so that neither the test nor the program waits for the other end.
Pipe::Pipe(const std::string& path) {
  if (mkfifo(path.c_str(), 0600) == 0) descriptor_ = open(path.c_str(), O_RDWR | O_NONBLOCK);
  if (descriptor_ < 0) throw std::runtime_error("no pipe at " + path);
}

Pipe::~Pipe() {
  close(descriptor_);
}

std::string Pipe::content() const {
  std::string bytes(65536, '\0');
  const ssize_t count = read(descriptor_, bytes.data(), bytes.size());
  bytes.resize(count < 0 ? 0 : static_cast<std::size_t>(count));
  return bytes;
}

RunningProgram::RunningProgram(const std::vector<std::string>& arguments)
    : process_(start(vat_words(arguments), folder_.file("out"), folder_.file("err"))) {}

RunningProgram::~RunningProgram() {
  if (process_ < 0) return;
  kill(process_, SIGKILL);
  waitpid(process_, nullptr, 0);
}

bool RunningProgram::wait_for_output(const std::string& text) const {
  return wait_until([&] { return read_file(folder_.file("out")).find(text) != std::string::npos; });
}

void RunningProgram::send(int signal) const {
  if (kill(process_, signal) != 0) throw std::runtime_error("the program is lost");
}

ProgramResult RunningProgram::finish() {
  const int exit_code = wait_for(std::exchange(process_, -1));
  return {exit_code, read_file(folder_.file("out")), read_file(folder_.file("err"))};
}

std::string test_scene(const std::string& name) {
  return VAT_SOURCE_DIR "/tests/cli/scenes/" + name + ".json";
}

std::string read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  EXPECT_TRUE(file) << path;
  std::ostringstream text;
  text << file.rdbuf();
  return std::move(text).str();
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

}  // namespace vat::test
