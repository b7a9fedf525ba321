#include "server/relay/relay_message.h"

#include <algorithm>
#include <iterator>
#include <mutex>
#include <utility>

#include "server/support/log.h"

namespace vat {
namespace {

/// NATS accepts messages of 1 MB.
constexpr std::size_t kMaxPart = std::size_t{512} * 1024;

}  // namespace

std::string write_relay_message(const RelayMessage& message) {
  const Json head{{"kind", to_string(message.kind)},
                  {"link", message.link},
                  {"number", message.number},
                  {"is_part", message.is_part},
                  {"fields", message.fields}};
  return head.dump() + '\n' + message.body;
}

std::optional<RelayMessage> read_relay_message(std::string_view bytes) {
  const auto end = bytes.find('\n');
  if (end == std::string_view::npos) return {};
  const Json head = Json::parse(bytes.substr(0, end), nullptr, false);
  try {
    const auto& names = kNamesOf<RelayKind>;
    const auto kind = std::ranges::find(names, head.at("kind").get<std::string>());
    if (kind == names.end() || !head.at("fields").is_object()) return {};
    return RelayMessage{static_cast<RelayKind>(kind - names.begin()),
                        head.at("link"),
                        head.at("number"),
                        head.at("is_part"),
                        head.at("fields"),
                        std::string(bytes.substr(end + 1))};
  } catch (const Json::exception&) {
    return {};
  }
}

RelayInput::Taken RelayInput::take(RelayMessage& message) {
  if (message.number != ++last_) return Taken::lost;
  if (message.is_part || !parts_.empty()) parts_ += message.body;
  if (message.is_part) return Taken::part;
  if (!parts_.empty()) message.body = std::exchange(parts_, {});
  return Taken::whole;
}

bool RelayLine::send(RelayKind kind, Json fields, std::string body) {
  const std::lock_guard lock(mutex_);
  try {
    const std::string_view all = body;
    std::size_t begin = 0;
    for (; all.size() - begin > kMaxPart; begin += kMaxPart) {
      connection_.publish(subject_,
                          write_relay_message({kind, link_, ++number_, true, Json::object(),
                                               std::string(all.substr(begin, kMaxPart))}));
    }
    connection_.publish(subject_,
                        write_relay_message({kind, link_, ++number_, false, std::move(fields),
                                             std::string(all.substr(begin))}));
    return true;
  } catch (const NatsError& error) {
    log_warning("relay: {}", error.what());
    return false;
  }
}

}  // namespace vat
