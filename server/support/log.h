#pragma once

#include <fmt/core.h>

#include <cstdint>

namespace vat {

enum class LogLevel : std::uint8_t { debug, info, warning, error };

/// Writes a message of the server's log if the log contains this level. The functions below check
/// the format at compile time. From any thread.
void write_log(LogLevel level, fmt::string_view format, fmt::format_args values);

template <class... T>
void log_debug(fmt::format_string<T...> format, T&&... values) {
  write_log(LogLevel::debug, format, fmt::make_format_args(values...));
}
template <class... T>
void log_info(fmt::format_string<T...> format, T&&... values) {
  write_log(LogLevel::info, format, fmt::make_format_args(values...));
}
template <class... T>
void log_warning(fmt::format_string<T...> format, T&&... values) {
  write_log(LogLevel::warning, format, fmt::make_format_args(values...));
}
template <class... T>
void log_error(fmt::format_string<T...> format, T&&... values) {
  write_log(LogLevel::error, format, fmt::make_format_args(values...));
}

}  // namespace vat
