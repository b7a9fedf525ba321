#include "server/replay/imports.h"

#include <utility>

#include "core/support/check.h"
#include "server/access/token.h"

namespace vat {
namespace {

RpcError bad_part(std::string path, std::string message) {
  return invalid_params({Error{"bad_value", std::move(path), std::move(message)}});
}

}  // namespace

std::variant<Imports::Progress, RpcError> Imports::add(ConnectionId client, Chunk part,
                                                       SteadyClock::time_point now) {
  const std::lock_guard lock(mutex_);
  forget_old_locked(now);
  if (part.size > kMaxRecordingBytes) return limit_reached("recording_bytes", kMaxRecordingBytes);
  if (held() + part.bytes.size() > most_bytes_) return limit_reached("import_bytes", most_bytes_);
  if (!part.name) {
    if (files_.size() >= kMaxFiles) return limit_reached("imports", kMaxFiles);
    part.name = make_token();
    files_[*part.name] = {client, part.size, {}, nullptr, 0, now};
  }
  const auto found = files_.find(*part.name);
  if (found == files_.end() || found->second.client != client || found->second.recording) {
    return bad_part("/recording", "must be a file that this connection has started");
  }
  File& file = found->second;
  if (file.size != part.size) return bad_part("/size", "must not change");
  if (part.offset != file.bytes.size()) {
    return bad_part("/offset",
                    "must be the end of the previous part, " + std::to_string(file.bytes.size()));
  }
  if (part.bytes.size() > file.size - part.offset) {
    return bad_part("/data", "must not exceed the size of the file");
  }
  file.bytes.insert(file.bytes.end(), part.bytes.begin(), part.bytes.end());
  file.held = file.bytes.size();
  VAT_CHECK(file.held <= file.size);
  file.end = now + kPatience;
  return Progress{*part.name, file.held, file.held == file.size};
}

std::optional<std::vector<std::uint8_t>> Imports::take_bytes(const std::string& name) {
  const std::lock_guard lock(mutex_);
  const auto found = files_.find(name);
  if (found == files_.end()) return {};
  return std::exchange(found->second.bytes, {});
}

void Imports::put(const std::string& name, std::shared_ptr<const Recording> recording,
                  SteadyClock::time_point now) {
  const std::lock_guard lock(mutex_);
  const auto found = files_.find(name);
  VAT_CHECK(recording != nullptr);
  if (found == files_.end()) return;
  found->second.recording = std::move(recording);
  found->second.end = now + kPatience;
}

void Imports::forget(const std::string& name) {
  const std::lock_guard lock(mutex_);
  files_.erase(name);
}

std::shared_ptr<const Recording> Imports::find(const std::string& name,
                                               SteadyClock::time_point now) {
  const std::lock_guard lock(mutex_);
  forget_old_locked(now);
  const auto found = files_.find(name);
  return found == files_.end() ? nullptr : found->second.recording;
}

std::size_t Imports::forget_old(SteadyClock::time_point now) {
  const std::lock_guard lock(mutex_);
  forget_old_locked(now);
  return held();
}

void Imports::forget_old_locked(SteadyClock::time_point now) {
  VAT_CHECK(mutex_.is_held());
  std::erase_if(files_, [&](const auto& entry) { return entry.second.end < now; });
}

std::size_t Imports::held() const {
  VAT_CHECK(mutex_.is_held());
  std::size_t sum = 0;
  for (const auto& [name, file] : files_) sum += file.held;
  return sum;
}

}  // namespace vat
