#include "core/device/opencl/program.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>

// Kernels of a device. The test machine runs them by PoCL.

namespace vat::opencl::program_test {
namespace {

constexpr const char* kSource =
    "kernel void store(const int value, global int* to) { if (get_global_id(0) == 0) *to = value; "
    "}";

std::unique_ptr<Program> make_program() {
  Result<std::unique_ptr<Program>> program = Program::create(find_device(0).value(), kSource, "");
  EXPECT_TRUE(program.ok());
  return std::move(program).value();
}

TEST(DeviceProgram, RunsAKernelWithItsArguments) {
  const std::unique_ptr<Program> program = make_program();
  const Buffer buffer(*program, sizeof(std::int32_t));
  for (const std::int32_t value : {5, 7}) {
    program->run("store", 1, value, buffer);
    std::int32_t stored = 0;
    program->read(buffer, std::span(&stored, 1));
    EXPECT_EQ(stored, value);
  }
}

// OpenCL would take the missing argument from the last run.
TEST(DeviceProgramDeathTest, ChecksTheNumberOfArguments) {
  const std::unique_ptr<Program> program = make_program();
  const Buffer buffer(*program, sizeof(std::int32_t));
  program->run("store", 1, std::int32_t{5}, buffer);
  EXPECT_DEATH(program->run("store", 1, std::int32_t{5}), "arguments");
  EXPECT_DEATH(program->run("store", 1, std::int32_t{5}, buffer, buffer), "arguments");
}

}  // namespace
}  // namespace vat::opencl::program_test
