#include "server/support/log.h"

#include <spdlog/spdlog.h>

#include <string_view>

namespace vat {
namespace {

spdlog::level::level_enum level_of(LogLevel level) {
  switch (level) {
    case LogLevel::debug:
      return spdlog::level::debug;
    case LogLevel::info:
      return spdlog::level::info;
    case LogLevel::warning:
      return spdlog::level::warn;
    case LogLevel::error:
      break;
  }
  return spdlog::level::err;
}

}  // namespace

void write_log(LogLevel level, fmt::string_view format, fmt::format_args values) {
  spdlog::logger& log = *spdlog::default_logger_raw();
  if (log.should_log(level_of(level))) {
    log.log(level_of(level), std::string_view(fmt::vformat(format, values)));
  }
}

}  // namespace vat
