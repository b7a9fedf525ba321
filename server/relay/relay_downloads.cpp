#include "server/relay/relay_downloads.h"

#include <chrono>
#include <exception>
#include <utility>

#include "protocol/json/json_reader.h"
#include "server/support/log.h"

namespace vat {
namespace {

constexpr std::chrono::milliseconds kPartTime(5000);
constexpr const char* kText = "text/plain; charset=utf-8";

void refuse(const std::function<void(HttpResponse)>& answer, int status, const char* text) {
  HttpResponse response{status, kText, text, {{"Cache-Control", "no-store"}}};
  if (status == 503) response.headers.emplace_back("Retry-After", "2");
  answer(std::move(response));
}

void refuse_missing(const std::function<void(HttpResponse)>& answer) {
  refuse(answer, 404, "Not found.\n");
}

/// Returns whether the text can be the name of a node, and thus a part of a subject.
bool is_node_name(const std::string& text) {
  constexpr const char* kCharacters =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_";
  return !text.empty() && text.find_first_not_of(kCharacters) == std::string::npos;
}

/// A line of JSON, and the bytes of the part.
std::string write_part(const Downloads::Part& part) {
  return Json{{"name", part.name}, {"size", part.size}}.dump() + '\n' + part.content;
}

/// Returns nothing if the bytes are no part. The size is at most that of a recording.
std::optional<Downloads::Part> read_part(const std::string& bytes) {
  const auto end = bytes.find('\n');
  if (end == std::string::npos) return {};
  const Json head = Json::parse(bytes.substr(0, end), nullptr, false);
  if (!head.is_object() || !head.contains("name") || !head.contains("size")) return {};
  return Downloads::Part{head.at("name"), head.at("size"), bytes.substr(end + 1)};
}

}  // namespace

RelayDownloads::RelayDownloads(const std::string& node, NatsConnection& connection,
                               Downloads& downloads, const Clock& clock)
    : connection_(connection), downloads_(downloads), clock_(clock) {
  subscription_ = connection_.subscribe(subject_of(node),
                                        [this](const NatsMessage& request) { send_part(request); });
}

std::string RelayDownloads::subject_of(const std::string& node) {
  return "vat.relay." + node + ".downloads";
}

void RelayDownloads::send_part(const NatsMessage& request) {
  try {
    const Json wanted = Json::parse(request.data);
    const auto part = downloads_.read(wanted.at("path").get<std::string>(), wanted.at("offset"),
                                      kPartBytes, clock_.now());
    connection_.publish(request.reply_to, part ? write_part(*part) : "");
  } catch (const std::exception& error) {
    log_warning("a download of another node: {}", error.what());
  }
}

void RelayDownloads::fetch(const std::string& node, const std::string& path,
                           std::function<void(HttpResponse)> answer) {
  if (!is_node_name(node)) return refuse_missing(answer);
  auto transfer = std::make_shared<Transfer>();
  transfer->node = node;
  transfer->path = path;
  transfer->answer = std::move(answer);
  request_part(transfer);
}

void RelayDownloads::request_part(const std::shared_ptr<Transfer>& transfer) {
  const Json request{{"path", transfer->path}, {"offset", transfer->file.content.size()}};
  const std::string text = request.dump(-1, ' ', false, Json::error_handler_t::replace);
  connection_.request(subject_of(transfer->node), {}, text, kPartTime,
                      [this, transfer](const NatsConnection::Result& result) {
                        const auto* reply = std::get_if<NatsMessage>(&result);
                        try {
                          if (reply != nullptr) return take_part(transfer, reply->data);
                        } catch (const std::exception& error) {  // of another version, or no memory
                          log_warning("a download from {}: {}", transfer->node, error.what());
                        }
                        refuse(transfer->answer, 503, "The node with the file does not answer.\n");
                      });
}

void RelayDownloads::take_part(const std::shared_ptr<Transfer>& transfer,
                               const std::string& bytes) {
  const auto part = read_part(bytes);
  Downloads::File& file = transfer->file;
  if (!part || file.content.size() + part->content.size() > part->size) {
    return refuse_missing(transfer->answer);
  }
  if (transfer->room == nullptr) {
    transfer->room = downloads_.reserve(part->size, clock_.now());
    if (transfer->room == nullptr) {
      return refuse(transfer->answer, 503, "Too many files wait for download.\n");
    }
    file.name = part->name;
    file.content.reserve(part->size);
  }
  file.content += part->content;
  if (file.content.size() < part->size) {
    if (part->content.empty()) return refuse_missing(transfer->answer);  // it would never end
    return request_part(transfer);
  }
  transfer->answer(download_response(std::move(file)));
}

}  // namespace vat
