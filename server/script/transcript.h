#pragma once

#include <cstdint>
#include <fstream>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace vat::script {

/// File with the messages of connections. Each line is a JSON object with `connection`. It also
/// contains `sent` or `received` (the message), or `closed` (the close code). `wrong` is true if
/// the server is expected to refuse the message. Thread-safe.
class Transcript {
 public:
  /// Creates the file `folder`/`name`.jsonl. Throws std::runtime_error if the file cannot be
  /// written.
  Transcript(const std::string& folder, const std::string& name);

  void sent(std::string_view connection, std::string_view message, bool wrong = false);
  void received(std::string_view connection, std::string_view message);
  /// Records the end of a connection by the server, or a connection failure (code 0).
  void closed(std::string_view connection, std::uint16_t code);

 private:
  void write(const nlohmann::json& line);

  std::mutex mutex_;
  std::ofstream file_;
};

}  // namespace vat::script
