#include <gtest/gtest.h>

#include "core/device/device_choice.h"

namespace vat::device_choice_test {
namespace {

TEST(DeviceChoice, ReadsEveryForm) {
  struct Case {
    const char* text;
    bool is_cpu;
    std::size_t index;
    DeviceArithmetic arithmetic;
  };
  for (const Case& one : {Case{"cpu", true, 0, DeviceArithmetic::exact},
                          Case{"opencl", false, 0, DeviceArithmetic::exact},
                          Case{"opencl:12", false, 12, DeviceArithmetic::exact},
                          Case{"opencl:fast", false, 0, DeviceArithmetic::fast},
                          Case{"opencl:3:fast", false, 3, DeviceArithmetic::fast}}) {
    SCOPED_TRACE(one.text);
    const Result<DeviceChoice> choice = parse_device(one.text);
    ASSERT_TRUE(choice.ok());
    EXPECT_EQ(choice.value().is_cpu, one.is_cpu);
    EXPECT_EQ(choice.value().index, one.index);
    EXPECT_EQ(choice.value().arithmetic, one.arithmetic);
  }
}

TEST(DeviceChoice, MayBeLeftToTheProgram) {
  const Result<DeviceChoice> choice = parse_device("auto");
  ASSERT_TRUE(choice.ok());
  EXPECT_TRUE(choice.value().is_auto);
  EXPECT_FALSE(parse_device("cpu").value().is_auto);
}

TEST(DeviceChoice, RefusesOtherTexts) {
  for (const char* text :
       {"", "gpu", "CPU", "cpu:0", "opencl:", "opencl:x", "opencl:-1", "opencl:1x", "opencl0",
        "opencl:1:", "opencl:1:slow", "opencl:99999999999999999999"}) {
    SCOPED_TRACE(text);
    const Result<DeviceChoice> choice = parse_device(text);
    ASSERT_FALSE(choice.ok());
    EXPECT_EQ(choice.errors().front().code, "bad_value");
    EXPECT_EQ(choice.errors().front().path, "/device");
  }
}

}  // namespace
}  // namespace vat::device_choice_test
