#include "server/nats/stream.h"

#include <algorithm>
#include <chrono>
#include <future>
#include <thread>
#include <utility>

#include "server/support/base64.h"

namespace vat {
namespace {

constexpr Stream::Milliseconds kAnswerTime(1000);
constexpr Stream::Milliseconds kAppendTime(500);
constexpr Stream::Milliseconds kRepeatTime(12'000);  // an election takes up to 10 s
constexpr Stream::Milliseconds kRepeatInterval(100);
constexpr Stream::Milliseconds kConcurrentTime(10'000);  // greatest age of an unordered message
constexpr Stream::Milliseconds kCreateTime(30'000);      // until new servers have elected a leader
constexpr Stream::Milliseconds kCreateInterval(250);
// Codes of JetStream.
constexpr int kNotFound = 10037;
constexpr int kStreamNotFound = 10059;
constexpr int kWrongLastSequence = 10071;
constexpr int kNoReplicas = 10074;
constexpr int kTooFewPeers = 10005;
constexpr int kSameIsInProcess = 10158;
constexpr int kNameInUse = 10058;
constexpr int kMaxReplicas = 3;

/// Returns the error of an answer, or nothing.
std::optional<NatsError> find_stream_error(const Json& answer, const std::string& operation) {
  const auto error = answer.find("error");
  if (error == answer.end()) return {};
  const int code = error->value("err_code", 0);
  const auto kind = code == kWrongLastSequence ? NatsError::Kind::conflict
                    : error->value("code", 0) == 503 || code == kSameIsInProcess
                        ? NatsError::Kind::unreachable
                        : NatsError::Kind::refused;
  return NatsError(kind, operation + ": " + error->value("description", std::string("an error")));
}

int stream_error_code(const Json& answer) {
  const auto error = answer.find("error");
  return error == answer.end() ? 0 : error->value("err_code", 0);
}

Json parse_answer(const NatsMessage& message) {
  Json answer = Json::parse(message.data, nullptr, false);
  if (!answer.is_object()) {
    throw NatsError(NatsError::Kind::refused, "JetStream sent an invalid answer");
  }
  return answer;
}

/// Reads "NATS/1.0\r\nKey: value\r\n...\r\n\r\n".
std::map<std::string, std::string> read_stored_headers(const std::string& text) {
  std::map<std::string, std::string> headers;
  std::size_t begin = text.find("\r\n");
  while (begin != std::string::npos) {
    begin += 2;
    const std::size_t end = text.find("\r\n", begin);
    const std::size_t colon = text.find(": ", begin);
    if (end == std::string::npos || colon == std::string::npos || colon > end) break;
    headers[text.substr(begin, colon - begin)] = text.substr(colon + 2, end - colon - 2);
    begin = end;
  }
  return headers;
}

std::string decode_text(const Json& message, const char* member) {
  const auto bytes = from_base64(message.value(member, std::string()));
  if (!bytes) throw NatsError(NatsError::Kind::refused, "JetStream sent an invalid message");
  return {bytes->begin(), bytes->end()};
}

/// Returns the headers of a message that requires the last message of its subject.
NatsConnection::Headers headers_after(const std::string& subject, std::uint64_t expected,
                                      const NatsConnection::Headers& headers) {
  NatsConnection::Headers all{{"Nats-Expected-Last-Subject-Sequence", std::to_string(expected)}};
  // Groups of servers compare the sequence before they order concurrent messages, and would store
  // several with the same `expected`. They compare the identifiers of messages after it. The
  // sequence 0 is compared after it as well.
  if (expected > 0) all.emplace_back("Nats-Msg-Id", subject + "." + std::to_string(expected));
  all.insert(all.end(), headers.begin(), headers.end());
  return all;
}

/// Calls `operation` again while no server answers, for example during the election of a leader.
template <class Operation>
auto repeat_until_answered(const Operation& operation) {
  const auto end = std::chrono::steady_clock::now() + kRepeatTime;
  for (;;) {
    try {
      return operation();
    } catch (const NatsError& error) {
      const bool is_answer =
          error.kind() == NatsError::Kind::refused || error.kind() == NatsError::Kind::conflict;
      if (is_answer || std::chrono::steady_clock::now() > end) throw;
    }
    std::this_thread::sleep_for(kRepeatInterval);
  }
}

}  // namespace

Stream::Stream(NatsConnection& connection, const Settings& settings)
    : connection_(connection), name_(settings.name) {
  const auto end = std::chrono::steady_clock::now() + kCreateTime;
  for (bool is_created = false; !is_created;) {
    try {
      create(settings);
      is_created = true;
      continue;
    } catch (const NatsError& error) {
      const bool may_end = error.kind() != NatsError::Kind::refused;
      if (!may_end || std::chrono::steady_clock::now() > end) throw;
    }
    std::this_thread::sleep_for(kCreateInterval);
  }
}

void Stream::create(const Settings& settings) {
  const Milliseconds id_time =
      settings.max_age.count() == 0 ? kConcurrentTime : std::min(kConcurrentTime, settings.max_age);
  Json config{
      {"name", name_},
      {"subjects", {settings.subjects}},
      {"storage", "file"},
      {"num_replicas", kMaxReplicas},
      {"max_msgs_per_subject",
       settings.max_per_subject == 0 ? -1 : static_cast<std::int64_t>(settings.max_per_subject)},
      {"max_age", std::chrono::nanoseconds(settings.max_age).count()},
      {"discard", settings.max_per_subject == 0 ? "old" : "new"},
      {"duplicate_window", std::chrono::nanoseconds(id_time).count()}};
  if (!settings.republish.empty()) {
    config["republish"] = {{"src", ">"}, {"dest", settings.republish + ".>"}};
  }
  const Json existing = call("INFO", Json::object());
  if (stream_error_code(existing) == 0) {
    Json changed = existing.at("config");
    if (changed.at("duplicate_window") == config.at("duplicate_window")) return;
    changed["duplicate_window"] = config.at("duplicate_window");  // an older version has made it
    const Json answer = call("UPDATE", changed);
    if (auto error = find_stream_error(answer, name_)) throw NatsError(*error);
    return;
  }
  Json answer = call("CREATE", config);
  const int code = stream_error_code(answer);
  if (code == kNoReplicas || code == kTooFewPeers) {
    config["num_replicas"] = 1;
    answer = call("CREATE", config);
  }
  if (stream_error_code(answer) == kNameInUse) return;  // another node was faster
  if (auto error = find_stream_error(answer, name_)) throw NatsError(*error);
}

Json Stream::call(const std::string& method, const Json& params) {
  return repeat_until_answered([&] {
    return parse_answer(
        connection_.request("$JS.API.STREAM." + method + "." + name_, params.dump(), kAnswerTime));
  });
}

void Stream::send(const std::string& subject, const NatsConnection::Headers& headers,
                  const std::string& data, std::function<void(Appended)> done) {
  connection_.request(subject, headers, data, kAppendTime,
                      [done = std::move(done), subject](NatsConnection::Result result) {
                        if (const auto* error = std::get_if<NatsError>(&result)) {
                          return done(*error);
                        }
                        const Json answer =
                            Json::parse(std::get<NatsMessage>(result).data, nullptr, false);
                        if (!answer.is_object()) {
                          return done(NatsError(NatsError::Kind::unreachable,
                                                subject + ": an invalid acknowledgement"));
                        }
                        if (auto error = find_stream_error(answer, subject)) return done(*error);
                        if (answer.value("duplicate", false)) {
                          return done(NatsError(NatsError::Kind::conflict,
                                                subject + ": another message was first"));
                        }
                        done(answer.value("seq", std::uint64_t{0}));
                      });
}

void Stream::append(const std::string& subject, const std::string& data, std::uint64_t expected,
                    const NatsConnection::Headers& headers, std::function<void(Appended)> done) {
  send(subject, headers_after(subject, expected, headers), data, std::move(done));
}

void Stream::append(const std::string& subject, const std::string& data,
                    std::function<void(Appended)> done) {
  send(subject, {}, data, std::move(done));
}

std::uint64_t Stream::append(const std::string& subject, const std::string& data,
                             std::uint64_t expected, const NatsConnection::Headers& headers) {
  return send_until_answered(subject, headers_after(subject, expected, headers), data, expected);
}

std::uint64_t Stream::append_after(const std::string& subject, const std::string& data,
                                   std::uint64_t last_sequence,
                                   const NatsConnection::Headers& headers) {
  const std::string expected = std::to_string(last_sequence);
  NatsConnection::Headers all{{"Nats-Expected-Last-Sequence", expected},
                              {"Nats-Msg-Id", "last." + expected}};
  all.insert(all.end(), headers.begin(), headers.end());
  return send_until_answered(subject, all, data, last_sequence);
}

std::uint64_t Stream::send_until_answered(const std::string& subject,
                                          const NatsConnection::Headers& headers,
                                          const std::string& data, std::uint64_t expected) {
  bool may_be_stored = false;  // by an earlier attempt
  return repeat_until_answered([&]() -> std::uint64_t {
    const auto promise = std::make_shared<std::promise<Appended>>();
    send(subject, headers, data,
         [promise](Appended result) { promise->set_value(std::move(result)); });
    const Appended result = promise->get_future().get();
    const auto* error = std::get_if<NatsError>(&result);
    if (error == nullptr) return std::get<std::uint64_t>(result);
    if (error->kind() == NatsError::Kind::conflict && may_be_stored) {
      const auto stored = last(subject);
      if (stored && stored->sequence > expected && stored->data == data) return stored->sequence;
    }
    may_be_stored = may_be_stored || error->kind() == NatsError::Kind::unreachable;
    throw NatsError(*error);
  });
}

std::optional<StoredMessage> Stream::get(const Json& params) {
  const Json answer = call("MSG.GET", params);
  const int code = stream_error_code(answer);
  if (code == kNotFound || code == kStreamNotFound) return {};
  if (auto error = find_stream_error(answer, name_)) throw NatsError(*error);
  const Json& message = answer.at("message");
  StoredMessage stored;
  stored.sequence = message.value("seq", std::uint64_t{0});
  stored.subject = message.value("subject", std::string());
  if (message.contains("hdrs")) stored.headers = read_stored_headers(decode_text(message, "hdrs"));
  if (message.contains("data")) stored.data = decode_text(message, "data");
  return stored;
}

std::optional<StoredMessage> Stream::last(const std::string& subject) {
  return get({{"last_by_subj", subject}});
}

std::optional<StoredMessage> Stream::find(std::uint64_t sequence) {
  return get({{"seq", sequence}});
}

std::optional<StoredMessage> Stream::next(const std::string& subject, std::uint64_t from) {
  return get({{"next_by_subj", subject}, {"seq", from}});
}

std::uint64_t Stream::last_sequence() {
  const Json answer = call("INFO", Json::object());
  if (auto error = find_stream_error(answer, name_)) throw NatsError(*error);
  return answer.at("state").at("last_seq");
}

std::optional<std::string> Stream::leader() {
  const Json answer = call("INFO", Json::object());
  if (auto error = find_stream_error(answer, name_)) throw NatsError(*error);
  const auto cluster = answer.find("cluster");
  if (cluster == answer.end() || !cluster->contains("replicas")) return {};
  const std::string leader = cluster->value("leader", std::string());
  if (leader.empty()) return {};
  return leader;
}

void Stream::change_leader() {
  const Json answer = call("LEADER.STEPDOWN", Json::object());
  if (auto error = find_stream_error(answer, name_)) throw NatsError(*error);
}

std::vector<std::string> Stream::subjects(const std::string& pattern) {
  std::vector<std::string> subjects;
  for (;;) {  // the server lists at most some thousands at once
    const Json answer = call("INFO", {{"subjects_filter", pattern}, {"offset", subjects.size()}});
    if (auto error = find_stream_error(answer, name_)) throw NatsError(*error);
    const Json& state = answer.at("state");
    const std::size_t before = subjects.size();
    if (const auto found = state.find("subjects"); found != state.end() && found->is_object()) {
      for (const auto& [subject, count] : found->items()) subjects.push_back(subject);
    }
    if (subjects.size() == before || subjects.size() >= answer.value("total", std::size_t{0})) {
      return subjects;
    }
  }
}

void Stream::purge(const std::string& subject, std::uint64_t before) {
  if (before <= 1) return;  // JetStream would remove all messages
  const Json answer = call("PURGE", {{"filter", subject}, {"seq", before}});
  if (auto error = find_stream_error(answer, name_)) throw NatsError(*error);
}

void Stream::purge_later(const std::string& subject, std::uint64_t before) {
  if (before <= 1) return;  // JetStream would remove all messages
  connection_.request("$JS.API.STREAM.PURGE." + name_, {},
                      Json{{"filter", subject}, {"seq", before}}.dump(), kAnswerTime,
                      [](const NatsConnection::Result&) {});
}

void Stream::purge(const std::string& subject) {
  const Json answer = call("PURGE", {{"filter", subject}});
  if (auto error = find_stream_error(answer, name_)) throw NatsError(*error);
}

}  // namespace vat
