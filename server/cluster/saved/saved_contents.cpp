#include "server/cluster/saved/saved_contents.h"

#include <algorithm>
#include <charconv>
#include <optional>

#include "server/access/token.h"
#include "server/storage/sqlite/storage_error.h"

namespace vat {
namespace {

constexpr std::string_view kPrefix = "vat.saved.";

std::string subject_of(const std::string& place) {
  return std::string(kPrefix) + place;
}

/// Returns the minute in a place, or nothing if the text is no place.
std::optional<std::uint64_t> minute_in(std::string_view place) {
  place.remove_prefix(std::min(place.find('.'), place.size() - 1) + 1);
  std::uint64_t minute = 0;
  const auto [end, error] = std::from_chars(place.data(), place.data() + place.size(), minute);
  if (error != std::errc() || end == place.data() + place.size() || *end != '.') return {};
  return minute;
}

}  // namespace

SavedContents::SavedContents(NatsConnection& connection, const Clock& clock)
    : clock_(clock),
      stream_(connection, {"vat-saved", "vat.saved.>", Stream::Milliseconds(0), 0, {}}) {}

std::uint64_t SavedContents::minute() const {
  return static_cast<std::uint64_t>(clock_.wall_time()) / 60;
}

std::string SavedContents::write(const std::string& owner, std::string_view content) {
  std::string place = owner + '.' + std::to_string(minute()) + '.' + make_token();
  const std::string subject = subject_of(place);
  std::uint64_t last = 0;
  for (std::size_t begin = 0; begin < content.size(); begin += kChunkBytes) {
    last = stream_.append(subject, std::string(content.substr(begin, kChunkBytes)), last);
  }
  return place;
}

std::string SavedContents::read(const std::string& place, std::size_t size) {
  const std::string subject = subject_of(place);
  std::string content;
  std::uint64_t from = 1;
  while (content.size() < size) {
    const auto chunk = stream_.next(subject, from);
    if (!chunk || chunk->data.empty()) break;
    content += chunk->data;
    from = chunk->sequence + 1;
  }
  if (content.size() == size) return content;
  throw StorageError(StorageError::Kind::corrupt, "saved data of the cluster is incomplete");
}

void SavedContents::remove(const std::string& place) {
  stream_.purge(subject_of(place));
}

void SavedContents::remove_all(const std::string& owner) {
  stream_.purge(subject_of(owner) + ".>");
}

void SavedContents::remove_unused(const std::string& owner, const std::set<std::string>& used) {
  const std::uint64_t now = minute();
  for (const std::string& subject : stream_.subjects(subject_of(owner) + ".>")) {
    const std::string place = subject.substr(kPrefix.size());
    const auto written = minute_in(place);
    if (written && *written + kUnusedMinutes <= now && !used.contains(place)) remove(place);
  }
}

}  // namespace vat
