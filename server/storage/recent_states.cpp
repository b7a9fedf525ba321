#include "server/storage/recent_states.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>
#include <utility>

#include "core/saved/sealed_bytes.h"
#include "core/support/byte_io.h"
#include "core/support/check.h"
#include "server/storage/sqlite/compression.h"

namespace vat {
namespace {

namespace fs = std::filesystem;

constexpr Seal kSeal{"vatrecnt", 1, "a recent state"};

std::vector<std::uint8_t> encode(const Checkpoint& checkpoint) {
  std::vector<std::uint8_t> bytes = begin_sealed(kSeal);
  ByteWriter writer(bytes);
  writer.put(checkpoint.session);
  writer.put(checkpoint.position);
  writer.put(checkpoint.sequence);
  writer.put(std::uint64_t{checkpoint.fields.size()});
  bytes.insert(bytes.end(), checkpoint.fields.begin(), checkpoint.fields.end());
  const std::vector<std::uint8_t> state = compress(checkpoint.state);
  bytes.insert(bytes.end(), state.begin(), state.end());
  close_seal(bytes);
  return bytes;
}

/// Returns nothing for a file that is incomplete or damaged. Compression limits the state's size.
std::optional<Checkpoint> decode(std::span<const std::uint8_t> file) {
  const auto content = open_sealed(kSeal, file);
  if (!content) return {};
  ByteReader reader(content.value());
  Checkpoint checkpoint;
  checkpoint.session = reader.get<std::uint64_t>();
  checkpoint.position = reader.get<std::uint64_t>();
  checkpoint.sequence = reader.get<std::uint64_t>();
  const auto length = reader.get<std::uint64_t>();
  if (reader.ended_early() || length > reader.left()) return {};
  const auto rest = content.value().last(reader.left());
  const auto fields = rest.first(static_cast<std::size_t>(length));
  checkpoint.fields.assign(fields.begin(), fields.end());
  try {
    checkpoint.state = decompress(rest.subspan(fields.size()), kMaxStateBytes);
  } catch (const StorageError&) {
    return {};
  }
  return checkpoint;
}

std::vector<std::uint8_t> read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Parses SESSION.WHICH. Returns nothing for other names.
std::optional<std::pair<std::uint64_t, std::size_t>> parse_name(const std::string& name) {
  std::uint64_t session = 0;
  const char* const end = name.data() + name.size();
  const auto [next, error] = std::from_chars(name.data(), end, session);
  const std::string_view rest(next, static_cast<std::size_t>(end - next));
  if (error != std::errc{} || (rest != ".0" && rest != ".1")) return {};
  return {{session, rest == ".1" ? 1U : 0U}};
}

}  // namespace

RecentStates::RecentStates(std::string folder, std::size_t bytes_in_all)
    : folder_(std::move(folder)), bytes_in_all_(bytes_in_all) {
  try {
    fs::create_directories(folder_);
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_)) {
      const auto name = parse_name(entry.path().filename().string());
      if (!name || !entry.is_regular_file()) continue;
      const auto [session, which] = *name;
      const auto size = static_cast<std::size_t>(entry.file_size());
      files_[session].bytes[which] = size;
      files_[session].newest = which;
      bytes_ += size;
    }
  } catch (const fs::filesystem_error& error) {
    throw StorageError(StorageError::Kind::failed, error.what());
  }
}

std::string RecentStates::path(std::uint64_t session, std::size_t which) const {
  return folder_ + "/" + std::to_string(session) + "." + std::to_string(which);
}

bool RecentStates::write(const Checkpoint& checkpoint) {
  const std::vector<std::uint8_t> bytes = encode(checkpoint);
  const std::lock_guard lock(mutex_);
  Files& files = files_[checkpoint.session];
  const std::size_t previous = files.newest;
  const std::size_t next = 1 - previous;
  remove_file(checkpoint.session, files, next);
  if (bytes_ - files.bytes[previous] + bytes.size() > bytes_in_all_) {
    remove_file(checkpoint.session, files, previous);
    return false;
  }
  const std::string name = path(checkpoint.session, next);
  std::ofstream file(name, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()),  // NOLINT: characters are bytes
             static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file) {
    std::error_code ignored;  // the write has failed already
    fs::remove(name, ignored);
    throw StorageError(StorageError::Kind::failed, name + " cannot be written");
  }
  files.bytes[next] = bytes.size();
  bytes_ += bytes.size();
  remove_file(checkpoint.session, files, previous);
  files.newest = next;
  return true;
}

std::optional<Checkpoint> RecentStates::read(std::uint64_t session) {
  const std::lock_guard lock(mutex_);
  std::optional<Checkpoint> newest;
  for (const std::size_t which : {0U, 1U}) {
    std::optional<Checkpoint> one = decode(read_file(path(session, which)));
    if (!one || one->session != session) continue;
    if (!newest ||
        std::pair(one->position, one->sequence) > std::pair(newest->position, newest->sequence)) {
      newest = std::move(one);
    }
  }
  return newest;
}

void RecentStates::keep_only(const std::vector<std::uint64_t>& sessions) {
  const std::lock_guard lock(mutex_);
  for (auto& [session, files] : files_) {
    if (std::ranges::find(sessions, session) != sessions.end()) continue;
    for (const std::size_t which : {0U, 1U}) remove_file(session, files, which);
  }
  std::erase_if(files_,
                [](const auto& one) { return one.second.bytes == std::array<std::size_t, 2>{}; });
}

void RecentStates::remove(std::uint64_t session) {
  const std::lock_guard lock(mutex_);
  const auto found = files_.find(session);
  if (found == files_.end()) return;
  for (const std::size_t which : {0U, 1U}) remove_file(session, found->second, which);
}

void RecentStates::remove_file(std::uint64_t session, Files& files, std::size_t which) {
  VAT_CHECK(mutex_.is_held() && which < 2);
  std::error_code error;
  fs::remove(path(session, which), error);
  if (error) throw StorageError(StorageError::Kind::failed, error.message());
  VAT_CHECK(bytes_ >= files.bytes[which]);
  bytes_ -= files.bytes[which];
  files.bytes[which] = 0;
}

}  // namespace vat
