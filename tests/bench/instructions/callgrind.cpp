#include "tests/bench/instructions/callgrind.h"

#include <charconv>
#include <cstdlib>
#include <fstream>
#include <string_view>
#include <system_error>

#include "tests/bench/instructions/counted_scenes.h"
#include "tests/bench/report/run_program.h"

namespace vat::bench {

namespace {

/// Disables the C library's functions for newer processors, such as memcpy, so that all machines
/// give the same count.
constexpr const char* kPlainLibrary =
    "glibc.cpu.hwcaps=-AVX,-AVX2,-AVX512F,-AVX512VL,-AVX512BW,-FMA,-FMA4,-BMI1,-BMI2,-LZCNT,"
    "-MOVBE,-ERMS,-FSRM,-SSSE3,-SSE4_1,-SSE4_2,-POPCNT";

}  // namespace

Result<std::uint64_t> parse_callgrind_total(const std::filesystem::path& file) {
  constexpr std::string_view kTotals = "totals: ";
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    if (!line.starts_with(kTotals)) continue;
    std::uint64_t total = 0;
    const char* end = line.data() + line.size();
    const auto [rest, error] = std::from_chars(line.data() + kTotals.size(), end, total);
    if (error == std::errc{} && rest == end && total > 0) return total;
  }
  return Error{"callgrind", file.string(), "has no total of instructions"};
}

Result<std::uint64_t> count_instructions(const std::string& scene,
                                         const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return Error{"system", folder.string(), error.message()};
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) return Error{"system", "/proc/self/exe", error.message()};
  setenv("GLIBC_TUNABLES", kPlainLibrary, 1);
  const std::string output = scene + ".callgrind";
  const Status run = run_program({"valgrind", "--tool=callgrind", "--callgrind-out-file=" + output,
                                  std::string("--toggle-collect=") + kCountedFunction,
                                  program.string(), kCountedCommand, scene},
                                 folder, scene + ".log", "./vat packages test installs it");
  if (!run) return run.errors();
  return parse_callgrind_total(folder / output);
}

}  // namespace vat::bench
