#include <gtest/gtest.h>

#include "core/scene/device_choice.h"
#include "tests/support/errors.h"

namespace vat::device_choice_test {
namespace {

TEST(DeviceChoice, ReadsEveryForm) {
  struct Case {
    const char* text;
    bool is_cpu;
    std::size_t index;
    DeviceArithmetic arithmetic;
    bool is_auto = false;
  };
  for (const Case& one : {Case{"cpu", true, 0, DeviceArithmetic::exact},
                          Case{"auto", true, 0, DeviceArithmetic::exact, true},
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
    EXPECT_EQ(choice.value().is_auto, one.is_auto);
    EXPECT_EQ(parse_device(to_text(choice.value())).value(), choice.value());
  }
  EXPECT_EQ(to_text(parse_device("opencl").value()), "opencl:0");
}

TEST(DeviceChoice, RefusesOtherTexts) {
  for (const char* text :
       {"", "gpu", "CPU", "cpu:0", "opencl:", "opencl:x", "opencl:-1", "opencl:1x", "opencl0",
        "opencl:1:", "opencl:1:slow", "opencl:9999999999"}) {
    EXPECT_EQ(test::errors_of(parse_device(text)), "bad_value /device") << text;
  }
}

}  // namespace
}  // namespace vat::device_choice_test
