#pragma once

#include <spdlog/formatter.h>

#include <memory>
#include <string>

namespace vat {

/// Formatter that writes each message as a JSON object on one line: time (UTC, RFC 3339), level,
/// message. Replaces invalid UTF-8 and line ends.
class JsonLogFormatter final : public spdlog::formatter {
 public:
  void format(const spdlog::details::log_msg& message, spdlog::memory_buf_t& line) override;
  std::unique_ptr<spdlog::formatter> clone() const override;
};

/// Writes all later messages of at least `level` to standard error, as text or as JSON objects.
void start_log(const std::string& level, bool json);

}  // namespace vat
