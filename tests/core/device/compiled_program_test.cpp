#include "core/device/opencl/compiled_program.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <thread>
#include <vector>

// Compiled programs of a process. The test machine compiles them by PoCL.

namespace vat::opencl::compiled_program_test {
namespace {

const std::string kSource = "kernel void nothing() {}";

std::shared_ptr<const CompiledProgram> compile(const std::string& source,
                                               const std::string& options) {
  const Result<Device> device = find_device(0);
  EXPECT_TRUE(device.ok());
  auto compiled = compile_once(device.value(), source, options);
  EXPECT_TRUE(compiled.ok());
  return compiled.value();
}

std::string option(std::size_t n) {
  return "-DVAT_NUMBER=" + std::to_string(n);
}

TEST(CompiledProgram, IsSharedByUsersOfOneSourceAndOptions) {
  const auto first = compile(kSource, "-DVAT_A");
  EXPECT_EQ(compile(kSource, "-DVAT_A"), first);
  EXPECT_NE(compile(kSource, "-DVAT_B"), first);
  EXPECT_NE(compile("kernel void other() {}", "-DVAT_A"), first);
}

TEST(CompiledProgram, IsCompiledOnceByConcurrentUsers) {
  std::vector<std::shared_ptr<const CompiledProgram>> programs(8);
  std::vector<std::thread> threads;
  for (auto& program : programs) {
    threads.emplace_back([&program] { program = compile(kSource, "-DVAT_CONCURRENT"); });
  }
  for (std::thread& thread : threads) thread.join();
  for (const auto& program : programs) EXPECT_EQ(program, programs.front());
}

TEST(CompiledProgram, IsKeptUntilManyOthersAreUsed) {
  std::weak_ptr<const CompiledProgram> first = compile(kSource, option(0));
  std::weak_ptr<const CompiledProgram> second = compile(kSource, option(1));
  for (std::size_t n = 2; n < kKeptPrograms; ++n) compile(kSource, option(n));
  EXPECT_FALSE(first.expired()) << "at the limit";
  compile(kSource, option(0));  // the second program is now the one whose last use is oldest
  compile(kSource, option(kKeptPrograms));
  EXPECT_FALSE(first.expired());
  EXPECT_TRUE(second.expired());
}

TEST(CompiledProgram, ReportsTheLogOfTheCompilerEachTime) {
  const Result<Device> device = find_device(0);
  ASSERT_TRUE(device.ok());
  for (int attempt = 0; attempt < 2; ++attempt) {
    const auto compiled = compile_once(device.value(), "kernel void broken() { unknown(); }", "");
    ASSERT_FALSE(compiled.ok());
    EXPECT_EQ(compiled.errors().front().code, "device_failed");
    EXPECT_NE(compiled.errors().front().message.find("unknown"), std::string::npos);
  }
}

}  // namespace
}  // namespace vat::opencl::compiled_program_test
