#include "server/script/transcript.h"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace vat::script {

Transcript::Transcript(const std::string& folder, const std::string& name) {
  std::filesystem::create_directories(folder);
  const std::string path = folder + '/' + name + ".jsonl";
  file_.open(path);
  if (!file_) throw std::runtime_error(path + ": cannot be written");
}

void Transcript::sent(std::string_view connection, std::string_view message, bool wrong) {
  nlohmann::json line{{"connection", connection}, {"sent", message}};
  if (wrong) line["wrong"] = true;
  write(line);
}

void Transcript::received(std::string_view connection, std::string_view message) {
  write({{"connection", connection}, {"received", message}});
}

void Transcript::closed(std::string_view connection, std::uint16_t code) {
  write({{"connection", connection}, {"closed", code}});
}

void Transcript::write(const nlohmann::json& line) {
  // Invalid UTF-8 is not a message.
  const std::string text =
      line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + '\n';
  const std::lock_guard lock(mutex_);
  file_ << text << std::flush;
}

}  // namespace vat::script
