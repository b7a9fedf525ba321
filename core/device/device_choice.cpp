#include "core/device/device_choice.h"

#include <charconv>
#include <string>

#include "core/device/opencl/devices.h"
#include "core/support/check.h"

namespace vat {

Result<DeviceChoice> parse_device(std::string_view text) {
  if (text == "cpu") return DeviceChoice{};
  if (text == "auto") return DeviceChoice{.is_auto = true};
  const Error bad{"bad_value", "/device",
                  "'" + std::string(text) + "' must be " + std::string(kDeviceForm)};
  constexpr std::string_view kOpenCl = "opencl";
  constexpr std::string_view kFast = ":fast";
  if (!text.starts_with(kOpenCl)) return bad;
  text.remove_prefix(kOpenCl.size());
  DeviceChoice choice{.is_cpu = false};
  if (text.ends_with(kFast)) {
    choice.arithmetic = DeviceArithmetic::fast;
    text.remove_suffix(kFast.size());
  }
  if (text.empty()) return choice;
  const char* end = text.data() + text.size();
  const auto [stop, code] = std::from_chars(text.data() + 1, end, choice.index);
  if (text[0] != ':' || code != std::errc() || stop != end) return bad;
  return choice;
}

Result<std::unique_ptr<StepEngine>> make_engine(const DeviceChoice& choice) {
  VAT_CHECK(!choice.is_auto);
  if (choice.is_cpu) return std::unique_ptr<StepEngine>();
  const Result<opencl::Device> device = opencl::find_device(choice.index);
  if (!device) return device.errors();
  return make_tait_engine(device.value(), choice.arithmetic);
}

}  // namespace vat
