#pragma once

#include <fstream>
#include <mutex>
#include <string>
#include <string_view>

namespace vat::script {

/// The text messages of some connections, written to a file as they go: a JSON object a line, with
/// `connection` and `sent` or `received`, the message as it stood; `wrong` is true where it is sent
/// to be refused. May be used by several threads.
class Transcript {
 public:
  /// Begins `folder`/`name`.jsonl anew. Throws std::runtime_error where it cannot be written.
  Transcript(const std::string& folder, const std::string& name);

  void sent(std::string_view connection, std::string_view message, bool wrong = false);
  void received(std::string_view connection, std::string_view message);

 private:
  void write(const char* what, std::string_view connection, std::string_view message, bool wrong);

  std::mutex mutex_;
  std::ofstream file_;
};

}  // namespace vat::script
