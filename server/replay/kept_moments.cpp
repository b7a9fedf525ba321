#include "server/replay/kept_moments.h"

#include <iterator>
#include <utility>

namespace vat {
namespace {

std::size_t bytes_of(const RecordedMoment& moment) {
  return moment.state.size() + moment.fields.size();
}

}  // namespace

void KeptMoments::add(RecordedMoment moment) {
  const std::size_t bytes = bytes_of(moment);
  const std::uint64_t position = moment.position;
  const std::lock_guard lock(mutex_);
  const bool is_new =
      moments_.emplace(position, std::make_shared<const RecordedMoment>(std::move(moment))).second;
  if (is_new) bytes_ += bytes;
  while (bytes_ > most_bytes_ && !moments_.empty()) thin();
}

std::shared_ptr<const RecordedMoment> KeptMoments::find(std::uint64_t position) const {
  const std::lock_guard lock(mutex_);
  const auto after = moments_.upper_bound(position);
  return after == moments_.begin() ? nullptr : std::prev(after)->second;
}

std::vector<std::uint64_t> KeptMoments::positions() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::uint64_t> positions;
  for (const auto& [position, moment] : moments_) positions.push_back(position);
  return positions;
}

std::size_t KeptMoments::count() const {
  const std::lock_guard lock(mutex_);
  return moments_.size();
}

std::size_t KeptMoments::bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

void KeptMoments::thin() {
  work_ = 2 * work_.load();
  bool goes = true;
  std::erase_if(moments_, [&](const auto& entry) {
    if (goes) bytes_ -= bytes_of(*entry.second);
    return std::exchange(goes, !goes);
  });
}

}  // namespace vat
