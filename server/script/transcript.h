#pragma once

#include <cstdint>
#include <fstream>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace vat::script {

/// The text messages of some connections, written to a file as they go: a JSON object a line, with
/// `connection` and `sent` or `received`, the message as it stood, or `closed`, the code; `wrong`
/// is true where a message is sent to be refused. May be used by several threads.
class Transcript {
 public:
  /// Begins `folder`/`name`.jsonl anew. Throws std::runtime_error where it cannot be written.
  Transcript(const std::string& folder, const std::string& name);

  void sent(std::string_view connection, std::string_view message, bool wrong = false);
  void received(std::string_view connection, std::string_view message);
  /// The server has closed the connection, or it broke: code 0.
  void closed(std::string_view connection, std::uint16_t code);

 private:
  void write(const nlohmann::json& line);

  std::mutex mutex_;
  std::ofstream file_;
};

}  // namespace vat::script
