#include "server/cluster/session_reader.h"

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <future>
#include <map>
#include <sstream>
#include <string>
#include <utility>

#include "server/storage/sqlite/compression.h"
#include "server/support/log.h"

namespace vat {
namespace {

constexpr int kFenceAttempts = 100;  // while the previous owner still appends

NatsConnection::Headers headers_of(const LocatedSession& session) {
  return {{kEpochHeader, std::to_string(session.epoch)},
          {kWriteHeader, std::to_string(session.epoch) + ".0"}};
}

/// Appends a record after which the previous owner can append nothing to the stream.
std::uint64_t end_previous_owner(ClusterStreams& streams, const LocatedSession& session,
                                 std::size_t stream) {
  const std::string subject = log_subject(session.number, stream);
  const std::string record = write_records({OwnerRecord{session.owner, session.epoch}});
  for (int attempt = 1;; ++attempt) {
    const auto last = streams.logs[stream].last(subject);
    if (!last && stream == 0) {
      throw StorageError(StorageError::Kind::corrupt,
                         "session s" + std::to_string(session.number) + " has no log");
    }
    try {
      return streams.logs[stream].append(subject, record, last ? last->sequence : 0,
                                         headers_of(session));
    } catch (const NatsError& error) {
      if (error.kind() != NatsError::Kind::conflict || attempt == kFenceAttempts) throw;
    }
  }
}

/// Returns the numbers of a write's identifier: the epoch, the write, and its part, if any.
std::vector<std::uint64_t> order_of(const StoredMessage& message) {
  std::vector<std::uint64_t> numbers;
  const auto id = message.headers.find(kWriteHeader);
  if (id == message.headers.end()) {
    throw StorageError(StorageError::Kind::corrupt, "a message of a log has no identifier");
  }
  std::istringstream text(id->second);
  for (std::string number; std::getline(text, number, '.');) {
    numbers.push_back(std::strtoull(number.c_str(), nullptr, 10));
  }
  return numbers;
}

/// Reads the chunks, or returns nothing if one is missing.
std::optional<PackedState> read_packed(ClusterStreams& streams,
                                       const std::vector<std::uint64_t>& chunks) {
  std::string bytes;
  for (const std::uint64_t chunk : chunks) {
    const auto message = streams.states.find(chunk);
    if (!message) return {};
    bytes += message->data;
  }
  if (bytes.empty()) return {};
  return unpack_state(bytes);
}

/// Writes the manifest again, so that a manifest of the previous owner is refused, and reads the
/// newest state.
std::optional<PackedState> take_state(ClusterStreams& streams, const LocatedSession& session,
                                      SessionImage& image) {
  const std::string subject = manifest_subject(session.number);
  for (int attempt = 1; image.manifest_message == 0; ++attempt) {
    const auto last = streams.states.last(subject);
    image.manifest = last ? read_manifest(last->data) : StateManifest();
    image.manifest.epoch = session.epoch;
    try {
      image.manifest_message = streams.states.append(
          subject, write_manifest(image.manifest), last ? last->sequence : 0, headers_of(session));
    } catch (const NatsError& error) {
      if (error.kind() != NatsError::Kind::conflict || attempt == kFenceAttempts) throw;
    }
  }
  if (auto newest = read_packed(streams, image.manifest.chunks)) return newest;
  if (!image.manifest.chunks.empty()) {
    log_warning("session s{}: its newest state is incomplete", session.number);
  }
  return read_packed(streams, image.manifest.previous);
}

struct ImageReader {
  SessionImage& image;
  const std::uint64_t first;  // sequence of the first entry that is needed

  void operator()(const EntriesRecord& record) {
    for (const LogEntry& entry : record.entries) {
      if (entry.sequence < first) continue;
      image.entries.push_back(entry);
    }
  }
  void operator()(const RefusedRecord& record) {
    for (LogEntry& entry : image.entries) {
      if (entry.sequence == record.sequence) entry.refused = true;
    }
  }
  void operator()(const ReachedRecord& record) {
    image.stored.reached = std::max(image.stored.reached, record.position);
  }
  void operator()(const SettingsRecord& record) {
    image.stored.name = record.name;
    image.stored.settings = record.settings;
  }
  void operator()(const OwnerRecord&) {}
  void operator()(const SessionProgress& progress) { image.stored.progress = progress; }
};

}  // namespace

SessionImage take_image(ClusterStreams& streams, const LocatedSession& session) {
  SessionImage image;
  image.stored.number = session.number;
  image.stored.name = session.name;
  image.stored.instruction_set = session.instruction_set;
  for (std::size_t i = 0; i < kLogStreams; ++i) {
    image.last_messages[i] = end_previous_owner(streams, session, i);
  }
  auto packed = take_state(streams, session, image);
  LogEnds after{};
  ImageReader reader{image, packed ? packed->state.sequence + 1 : 1};
  if (packed) {
    after = packed->covered;
    image.stored.name = packed->name;
    image.stored.settings = packed->settings;
    if (packed->loaded.sequence < reader.first) image.entries.push_back(packed->loaded);
    image.state = std::move(packed->state);
  }
  LogParts parts;
  for (StoredMessage& message : read_log(streams, session.number, after, image.last_messages)) {
    const auto whole = parts.take(message.headers[kPartHeader], message.data);
    if (!whole) continue;
    for (const LogRecord& record : read_records(*whole)) std::visit(reader, record);
  }
  return image;
}

LogEnds last_messages(ClusterStreams& streams, std::uint64_t session) {
  LogEnds ends{};
  for (std::size_t i = 0; i < kLogStreams; ++i) {
    const auto last = streams.logs[i].last(log_subject(session, i));
    if (last) ends[i] = last->sequence;
  }
  return ends;
}

std::vector<StoredMessage> read_log(ClusterStreams& streams, std::uint64_t session,
                                    const LogEnds& after, const LogEnds& last) {
  std::map<std::vector<std::uint64_t>, StoredMessage> ordered;
  for (std::size_t i = 0; i < kLogStreams; ++i) {
    for (std::uint64_t from = after[i] + 1; from <= last[i];) {
      auto message = streams.logs[i].next(log_subject(session, i), from);
      if (!message) {
        throw StorageError(StorageError::Kind::corrupt,
                           "session s" + std::to_string(session) + ": its log is incomplete");
      }
      from = message->sequence + 1;
      ordered.emplace(order_of(*message), *std::move(message));
    }
  }
  std::vector<StoredMessage> messages;
  messages.reserve(ordered.size());
  for (auto& [order, message] : ordered) messages.push_back(std::move(message));
  return messages;
}

namespace {

void replace_session(Storage& storage, const SessionImage& image) {
  const std::uint64_t number = image.stored.number;
  storage.checkpoints().remove(number);
  storage.recent_states().remove(number);
  storage.sessions().replace(image.stored, image.entries);
  if (!image.state) return;
  Checkpoint state = *image.state;
  state.state = decompress(state.state, kMaxStateBytes);
  storage.checkpoints().write(state);
}

}  // namespace

void store_image(Storage& storage, const SessionImage& image) {
  storage.flush();
  // On the storage's thread, so that Storage::remove_closed() does not remove the checkpoint.
  std::promise<void> done;
  storage.post([&] {
    try {
      replace_session(storage, image);
      done.set_value();
    } catch (...) {
      done.set_exception(std::current_exception());
    }
  });
  done.get_future().get();
}

void remove_messages(ClusterStreams& streams, std::uint64_t session) {
  streams.states.purge(chunk_subject(session));
  streams.states.purge(manifest_subject(session));
  for (std::size_t i = 0; i < kLogStreams; ++i) streams.logs[i].purge(log_subject(session, i));
}

}  // namespace vat
