#pragma once

#include <cstdint>
#include <fstream>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace vat::script {

/// Messages of connections, written to a file: one JSON object per line with `connection` and
/// `sent` or `received` (the message) or `closed` (the code). `wrong` is true if a message is
/// expected to be refused. Safe to use from several threads.
class Transcript {
 public:
  /// Starts a new file `folder`/`name`.jsonl. Throws std::runtime_error if it cannot be written.
  Transcript(const std::string& folder, const std::string& name);

  void sent(std::string_view connection, std::string_view message, bool wrong = false);
  void received(std::string_view connection, std::string_view message);
  /// The server has closed the connection, or it broke (code 0).
  void closed(std::string_view connection, std::uint16_t code);

 private:
  void write(const nlohmann::json& line);

  std::mutex mutex_;
  std::ofstream file_;
};

}  // namespace vat::script
