#include "server/replay/moment_cache.h"

#include <iterator>
#include <utility>
#include "core/support/check.h"

namespace vat {
namespace {

std::size_t bytes_of(const RecordedMoment& moment) {
  return moment.state.size() + moment.fields.size();
}

}  // namespace

void MomentCache::add(RecordedMoment moment) {
  const std::size_t bytes = bytes_of(moment);
  const std::uint64_t position = moment.position;
  const std::lock_guard lock(mutex_);
  const bool is_new =
      moments_.emplace(position, std::make_shared<const RecordedMoment>(std::move(moment))).second;
  if (is_new) bytes_ += bytes;
  while (bytes_ > most_bytes_ && !moments_.empty()) thin();
  VAT_CHECK(bytes_ <= most_bytes_);
}

std::shared_ptr<const RecordedMoment> MomentCache::find(std::uint64_t position) const {
  const std::lock_guard lock(mutex_);
  const auto after = moments_.upper_bound(position);
  return after == moments_.begin() ? nullptr : std::prev(after)->second;
}

std::vector<std::uint64_t> MomentCache::positions() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::uint64_t> positions;
  for (const auto& [position, moment] : moments_) positions.push_back(position);
  return positions;
}

std::size_t MomentCache::count() const {
  const std::lock_guard lock(mutex_);
  return moments_.size();
}

std::size_t MomentCache::bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

void MomentCache::thin() {
  VAT_CHECK(!moments_.empty());
  work_ = 2 * work_.load();
  bool goes = true;
  std::erase_if(moments_, [&](const auto& entry) {
    if (goes) bytes_ -= bytes_of(*entry.second);
    return std::exchange(goes, !goes);
  });
}

}  // namespace vat
