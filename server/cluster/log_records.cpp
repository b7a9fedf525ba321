#include "server/cluster/log_records.h"

#include <algorithm>
#include <charconv>
#include <span>
#include <utility>

#include "protocol/json/json_reader.h"
#include "server/storage/sqlite/compression.h"

namespace vat {
namespace {

constexpr std::size_t kPlainBytes = 8 * 1024;  // shorter messages are not compressed
constexpr std::size_t kMaxMessageBytes = std::size_t{256} << 20;
constexpr char kPlain = 'j';
constexpr char kCompressed = 'z';

[[noreturn]] void fail_record(const std::string& reason) {
  throw StorageError(StorageError::Kind::corrupt, "a message of a session's log: " + reason);
}

/// Calls `read` with the JSON, and converts its errors.
template <class Read>
auto read_record_json(const std::string& bytes, const Read& read) {
  try {
    return read(Json::parse(bytes));
  } catch (const Json::exception& error) {
    fail_record(error.what());
  }
}

Json to_record_json(const LogEntry& entry) {
  return {entry.sequence, entry.position, entry.tick,   entry.participant,
          entry.method,   entry.params,   entry.refused};
}

LogEntry read_entry(const Json& json) {
  return {json.at(0), json.at(1), json.at(2), json.at(3), json.at(4), json.at(5), json.at(6)};
}

struct RecordWriter {
  Json operator()(const EntriesRecord& record) const {
    Json entries = Json::array();
    for (const LogEntry& entry : record.entries) entries.push_back(to_record_json(entry));
    return {{"entries", std::move(entries)}};
  }
  Json operator()(const RefusedRecord& record) const { return {{"refused", record.sequence}}; }
  Json operator()(const ReachedRecord& record) const { return {{"reached", record.position}}; }
  Json operator()(const SettingsRecord& record) const {
    return {{"name", record.name}, {"settings", record.settings}};
  }
  Json operator()(const OwnerRecord& record) const {
    return {{"owner", record.node}, {"epoch", record.epoch}};
  }
  Json operator()(const SessionProgress& progress) const {
    return {{"progress",
             {progress.position, progress.tick, progress.sequence, progress.hash, progress.epoch,
              progress.playing, progress.speed, progress.participants}}};
  }
};

LogRecord read_log_record(const Json& json) {
  if (json.contains("entries")) {
    EntriesRecord record;
    for (const Json& entry : json.at("entries")) record.entries.push_back(read_entry(entry));
    if (record.entries.empty()) fail_record("it has no entries");
    return record;
  }
  if (json.contains("refused")) return RefusedRecord{json.at("refused")};
  if (json.contains("reached")) return ReachedRecord{json.at("reached")};
  if (json.contains("settings")) return SettingsRecord{json.at("name"), json.at("settings")};
  if (json.contains("owner")) return OwnerRecord{json.at("owner"), json.at("epoch")};
  const Json& list = json.at("progress");
  return SessionProgress{list.at(0), list.at(1), list.at(2), list.at(3),
                         list.at(4), list.at(5), list.at(6), list.at(7)};
}

std::span<const std::uint8_t> text_bytes(const std::string& text, std::size_t from = 0) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()) + from, text.size() - from};
}

}  // namespace

std::string write_records(const std::vector<LogRecord>& records) {
  Json list = Json::array();
  for (const LogRecord& record : records) list.push_back(std::visit(RecordWriter(), record));
  const std::string text = list.dump();
  if (text.size() < kPlainBytes) return kPlain + text;
  const std::vector<std::uint8_t> compressed = compress(text_bytes(text));
  return kCompressed + std::string(compressed.begin(), compressed.end());
}

std::vector<LogRecord> read_records(const std::string& bytes) {
  if (bytes.empty()) fail_record("it is empty");
  std::string text = bytes.substr(1);
  if (bytes.front() == kCompressed) {
    const std::vector<std::uint8_t> plain = decompress(text_bytes(bytes, 1), kMaxMessageBytes);
    text.assign(plain.begin(), plain.end());
  }
  return read_record_json(text, [](const Json& list) {
    std::vector<LogRecord> records;
    for (const Json& record : list) records.push_back(read_log_record(record));
    return records;
  });
}

std::deque<LogPart> split_message(const std::string& bytes) {
  const std::size_t count =
      std::max<std::size_t>(1, (bytes.size() + LogPart::kBytes - 1) / LogPart::kBytes);
  std::deque<LogPart> parts;
  for (std::size_t i = 0; i < count; ++i) {
    parts.push_back({std::to_string(i) + "/" + std::to_string(count),
                     bytes.substr(i * LogPart::kBytes, LogPart::kBytes)});
  }
  return parts;
}

std::optional<std::string> LogParts::take(const std::string& header, const std::string& bytes) {
  if (header.empty()) {
    next_ = 0;
    return bytes;
  }
  std::size_t index = 0;
  std::size_t count = 0;
  const char* const end = header.data() + header.size();
  const auto number = std::from_chars(header.data(), end, index);
  const bool has_count = number.ec == std::errc() && number.ptr != end && *number.ptr == '/';
  if (!has_count || std::from_chars(number.ptr + 1, end, count).ec != std::errc()) {
    fail_record("its part has the header " + header);
  }
  if (index == 0) joined_.clear();
  if (index != 0 && index != next_) fail_record("a part is missing");
  joined_ += bytes;
  next_ = index + 1;
  if (next_ < count) return {};
  next_ = 0;
  return std::move(joined_);
}

namespace {

/// Versions with one stream have written one number.
LogEnds read_ends(const Json& json) {
  if (!json.is_number()) return json.get<LogEnds>();
  LogEnds ends{};
  ends[0] = json.get<std::uint64_t>();
  return ends;
}

}  // namespace

std::string pack_state(const PackedState& packed) {
  const Json head{{"session", packed.state.session},
                  {"position", packed.state.position},
                  {"sequence", packed.state.sequence},
                  {"fields", packed.state.fields},
                  {"loaded", to_record_json(packed.loaded)},
                  {"name", packed.name},
                  {"settings", packed.settings},
                  {"covered", packed.covered}};
  const std::string text = head.dump();
  const std::vector<std::uint8_t> compressed = compress(text_bytes(text));
  std::string bytes = std::to_string(compressed.size()) + '\n';
  bytes.append(compressed.begin(), compressed.end());
  bytes.append(packed.state.state.begin(), packed.state.state.end());
  return bytes;
}

PackedState unpack_state(const std::string& bytes) {
  const std::size_t line = bytes.find('\n');
  if (line == std::string::npos || line > 20) fail_record("the state has no head");
  const std::size_t head = std::strtoull(bytes.c_str(), nullptr, 10);
  const std::size_t begin = line + 1;
  if (head > bytes.size() - begin) fail_record("the state is incomplete");
  const std::vector<std::uint8_t> text =
      decompress(text_bytes(bytes, begin).first(head), kMaxMessageBytes);
  PackedState packed = read_record_json({text.begin(), text.end()}, [](const Json& json) {
    PackedState read;
    read.state.session = json.at("session");
    read.state.position = json.at("position");
    read.state.sequence = json.at("sequence");
    read.state.fields = json.at("fields");
    read.loaded = read_entry(json.at("loaded"));
    read.name = json.at("name");
    read.settings = json.at("settings");
    read.covered = read_ends(json.at("covered"));
    return read;
  });
  const auto rest = text_bytes(bytes, begin + head);
  packed.state.state.assign(rest.begin(), rest.end());
  return packed;
}

std::string write_manifest(const StateManifest& manifest) {
  return Json{{"epoch", manifest.epoch},
              {"chunks", manifest.chunks},
              {"covered", manifest.covered},
              {"previous", manifest.previous},
              {"previous_covered", manifest.previous_covered}}
      .dump();
}

StateManifest read_manifest(const std::string& bytes) {
  return read_record_json(bytes, [](const Json& json) {
    return StateManifest{json.at("epoch"), json.at("chunks"), read_ends(json.at("covered")),
                         json.at("previous"), read_ends(json.at("previous_covered"))};
  });
}

}  // namespace vat
