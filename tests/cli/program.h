#pragma once

#include <string>
#include <vector>

#include "tests/support/temporary_folder.h"

namespace vat::test {

struct ProgramResult {
  int exit_code = -1;  ///< -1: killed by a signal
  std::string out;
  std::string err;
};

/// Runs the built program to its end.
ProgramResult run_vat(const std::vector<std::string>& arguments);
/// The same for `vat bench`.
ProgramResult run_bench(const std::vector<std::string>& arguments);

/// The same where no file, standard output and error included, may grow beyond `blocks` of
/// 512 bytes, as on a disk that fills up.
ProgramResult run_vat_with_file_limit(int blocks, const std::vector<std::string>& arguments);

/// Path of one of the scenes beside these tests.
std::string test_scene(const std::string& name);

/// The whole content of a file; fails the test where it cannot be read.
std::string read_file(const std::string& path);

std::vector<std::string> lines_of(const std::string& text);

/// A named pipe, made in a folder of the test's own and held open for reading.
class Pipe {
 public:
  explicit Pipe(const std::string& path);
  ~Pipe();
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  /// What was written to it and not yet read; at most the 64 KiB that a pipe holds.
  std::string content() const;

 private:
  int descriptor_ = -1;
};

/// The built program at work; ended by force if it still is when this goes.
class RunningProgram {
 public:
  explicit RunningProgram(const std::vector<std::string>& arguments);
  ~RunningProgram();
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;

  void send(int signal) const;
  /// Waits for its end.
  ProgramResult finish();

 private:
  TemporaryFolder folder_;
  int process_ = -1;
};

}  // namespace vat::test
