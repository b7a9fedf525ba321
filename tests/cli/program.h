#pragma once

#include <gmock/gmock.h>

#include <ostream>
#include <string>
#include <vector>

#include "tests/support/temporary_folder.h"

namespace vat::test {

struct ProgramResult {
  int exit_code = -1;  ///< -1: killed by a signal
  std::string out;
  std::string err;
};

inline void PrintTo(const ProgramResult& result, std::ostream* out) {
  *out << "exit code " << result.exit_code << '\n' << result.out << result.err;
}

/// Matches a program that exited with this code and a matching text on standard error.
template <class Message>
auto exits(int code, const Message& message) {
  return testing::AllOf(testing::Field("exit_code", &ProgramResult::exit_code, code),
                        testing::Field("err", &ProgramResult::err, message));
}

/// Runs the built program to its end.
ProgramResult run_vat(const std::vector<std::string>& arguments);
/// Runs `vat bench`.
ProgramResult run_bench(const std::vector<std::string>& arguments);

/// Runs the program with all files, including standard output and error, limited to `blocks` of 512
/// bytes, as on a full disk.
ProgramResult run_vat_with_file_limit(int blocks, const std::vector<std::string>& arguments);

/// Returns the path of a scene in tests/cli/scenes.
std::string test_scene(const std::string& name);

/// Returns the content of a file. Fails the test if it cannot be read.
std::string read_file(const std::string& path);

std::vector<std::string> lines_of(const std::string& text);

/// A named pipe, opened for reading.
class Pipe {
 public:
  explicit Pipe(const std::string& path);
  ~Pipe();
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  /// Returns the written data that was not read yet; at most 64 KiB, the capacity of a pipe.
  std::string content() const;

 private:
  int descriptor_ = -1;
};

/// The running program. The destructor kills it if it is still running.
class RunningProgram {
 public:
  explicit RunningProgram(const std::vector<std::string>& arguments);
  ~RunningProgram();
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;

  /// Waits until standard output contains the text.
  bool wait_for_output(const std::string& text) const;
  void send(int signal) const;
  /// Waits for its end.
  ProgramResult finish();

 private:
  TemporaryFolder folder_;
  int process_ = -1;
};

}  // namespace vat::test
