#pragma once

#include <spdlog/formatter.h>

#include <memory>
#include <string>

namespace vat {

/// Makes an object of every message, one a line: time (UTC, RFC 3339), level, message. What is not
/// UTF-8 in a message is replaced, and nothing in it can end the line.
class JsonLogFormatter final : public spdlog::formatter {
 public:
  void format(const spdlog::details::log_msg& message, spdlog::memory_buf_t& line) override;
  std::unique_ptr<spdlog::formatter> clone() const override;
};

/// All further messages go to standard error: those of `level` or above, as text or, where `json`,
/// as objects.
void start_log(const std::string& level, bool json);

}  // namespace vat
