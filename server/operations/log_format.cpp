#include "server/operations/log_format.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <array>
#include <chrono>
#include <ctime>
#include <nlohmann/json.hpp>
#include <string_view>

namespace vat {
namespace {

std::string utc_time(spdlog::log_clock::time_point time) {
  using std::chrono::milliseconds;
  const std::time_t seconds = spdlog::log_clock::to_time_t(time);
  const auto since = std::chrono::duration_cast<milliseconds>(time.time_since_epoch());
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  std::array<char, 40> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%S", &parts);
  const std::string fraction = std::to_string(1000 + since.count() % 1000);
  return std::string(text.data()) + '.' + fraction.substr(1) + 'Z';
}

std::string_view view(spdlog::string_view_t text) {
  return {text.data(), text.size()};
}

}  // namespace

void JsonLogFormatter::format(const spdlog::details::log_msg& message, spdlog::memory_buf_t& line) {
  const nlohmann::ordered_json object{{"time", utc_time(message.time)},
                                      {"level", view(spdlog::level::to_string_view(message.level))},
                                      {"message", view(message.payload)}};
  using Handler = nlohmann::ordered_json::error_handler_t;
  const std::string text = object.dump(-1, ' ', false, Handler::replace) + '\n';
  line.append(text.data(), text.data() + text.size());
}

std::unique_ptr<spdlog::formatter> JsonLogFormatter::clone() const {
  return std::make_unique<JsonLogFormatter>();
}

void start_log(const std::string& level, bool json) {
  spdlog::set_default_logger(spdlog::stderr_color_mt("vat"));
  if (json) spdlog::set_formatter(std::make_unique<JsonLogFormatter>());
  spdlog::set_level(spdlog::level::from_str(level));
}

}  // namespace vat
