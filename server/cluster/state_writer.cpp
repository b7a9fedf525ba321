#include "server/cluster/state_writer.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "server/support/log.h"

namespace vat {
namespace {

constexpr std::size_t kChunkBytes = 384 * 1024;  // a message of NATS has at most 1 MB by default

}  // namespace

StateWriter::StateWriter(ClusterStreams& streams, std::uint64_t session, std::uint64_t epoch,
                         StateManifest manifest, std::uint64_t sequence)
    : streams_(streams),
      session_(session),
      epoch_(epoch),
      manifest_(std::move(manifest)),
      manifest_sequence_(sequence) {}

void StateWriter::write(PackedState state, bool always) {
  {
    const std::lock_guard lock(mutex_);
    if (is_writing_) {
      if (always) waiting_ = std::move(state);
      return;
    }
    is_writing_ = true;
  }
  if (read_manifest_again()) return begin(std::move(state));
  end();
}

bool StateWriter::read_manifest_again() {
  if (!is_unsure_) return true;
  try {
    const auto last = streams_.states.last(manifest_subject(session_));
    StateManifest manifest = last ? read_manifest(last->data) : StateManifest();
    if (last && manifest.epoch != epoch_) return false;  // the session has another owner
    const std::lock_guard lock(mutex_);
    manifest_ = std::move(manifest);
    manifest_sequence_ = last ? last->sequence : 0;
    is_unsure_ = false;
    return true;
  } catch (const std::exception& error) {
    log_warning("session s{}: a state is not stored: {}", session_, error.what());
    return false;
  }
}

void StateWriter::flush(Stored done) {
  {
    const std::lock_guard lock(mutex_);
    if (is_writing_) return flushes_.push_back(std::move(done));
  }
  done();
}

void StateWriter::begin(PackedState state) {
  const std::string bytes = pack_state(state);
  state.state.state.clear();  // only the rest is needed for the manifest
  const auto writing = std::make_shared<Writing>();
  writing->state = std::move(state);
  const std::size_t count = (bytes.size() + kChunkBytes - 1) / kChunkBytes;
  writing->chunks.resize(count);
  writing->left = count;
  for (std::size_t i = 0; i < count; ++i) {
    streams_.states.append(chunk_subject(session_), bytes.substr(i * kChunkBytes, kChunkBytes),
                           [self = shared_from_this(), writing, i](const Stream::Appended& result) {
                             self->chunk_stored(writing, i, result);
                           });
  }
}

void StateWriter::chunk_stored(const std::shared_ptr<Writing>& writing, std::size_t index,
                               const Stream::Appended& result) {
  {
    const std::lock_guard lock(mutex_);
    if (const auto* error = std::get_if<NatsError>(&result)) {
      if (!std::exchange(writing->has_failed, true)) {
        log_warning("session s{}: a state is not stored: {}", session_, error->what());
      }
    } else {
      writing->chunks[index] = std::get<std::uint64_t>(result);
    }
    if (--writing->left > 0) return;
  }
  if (writing->has_failed) return end();
  write_manifest_of(writing);
}

void StateWriter::write_manifest_of(const std::shared_ptr<Writing>& writing) {
  StateManifest manifest;
  std::uint64_t expected = 0;
  {
    const std::lock_guard lock(mutex_);
    manifest = {epoch_, writing->chunks, writing->state.covered, manifest_.chunks,
                manifest_.covered};
    expected = manifest_sequence_;
  }
  // A later owner has replaced the manifest, so that states of this node do not count any more.
  streams_.states.append(manifest_subject(session_), write_manifest(manifest), expected,
                         {{kEpochHeader, std::to_string(epoch_)}},
                         [self = shared_from_this(), manifest](const Stream::Appended& result) {
                           self->manifest_stored(manifest, result);
                         });
}

void StateWriter::manifest_stored(const StateManifest& manifest, const Stream::Appended& result) {
  if (const auto* error = std::get_if<NatsError>(&result)) {
    log_warning("session s{}: a state is not stored: {}", session_, error->what());
    is_unsure_ = true;  // the manifest may have been stored
    return end();
  }
  {
    const std::lock_guard lock(mutex_);
    manifest_ = manifest;
    manifest_sequence_ = std::get<std::uint64_t>(result);
  }
  purge(manifest, std::get<std::uint64_t>(result));
  end();
}

void StateWriter::purge(const StateManifest& manifest, std::uint64_t sequence) {
  if (manifest.previous.empty()) return;
  const std::uint64_t first = *std::ranges::min_element(manifest.previous);
  streams_.states.purge_later(chunk_subject(session_), first);
  streams_.states.purge_later(manifest_subject(session_), sequence);
  for (std::size_t i = 0; i < kLogStreams; ++i) {
    streams_.logs[i].purge_later(log_subject(session_, i), manifest.previous_covered[i] + 1);
  }
}

void StateWriter::end() {
  std::optional<PackedState> next;
  std::vector<Stored> flushes;
  {
    const std::lock_guard lock(mutex_);
    next = std::exchange(waiting_, std::nullopt);
    is_writing_ = next.has_value();
    if (!next) flushes.swap(flushes_);
  }
  if (next) return begin(*std::move(next));
  for (const Stored& done : flushes) done();
}

}  // namespace vat
