#include "core/scene/device_choice.h"

#include <charconv>

namespace vat {

Result<DeviceChoice> parse_device(std::string_view text) {
  if (text == "cpu") return DeviceChoice{};
  if (text == "auto") return DeviceChoice{.is_auto = true};
  const Error bad{"bad_value", "/device",
                  "'" + std::string(text) + "' must be " + std::string(kDeviceForm)};
  constexpr std::string_view kOpenCl = "opencl";
  constexpr std::string_view kFast = ":fast";
  constexpr std::size_t kMaxDigits = 9;
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
  if (text[0] != ':' || text.size() > 1 + kMaxDigits || code != std::errc() || stop != end) {
    return bad;
  }
  return choice;
}

std::string to_text(const DeviceChoice& choice) {
  if (choice.is_auto) return "auto";
  if (choice.is_cpu) return "cpu";
  const bool is_fast = choice.arithmetic == DeviceArithmetic::fast;
  return "opencl:" + std::to_string(choice.index) + (is_fast ? ":fast" : "");
}

}  // namespace vat
