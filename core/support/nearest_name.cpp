#include "core/support/nearest_name.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

namespace vat {
namespace {

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& letter : result) {
    if (letter >= 'A' && letter <= 'Z') letter = static_cast<char>(letter - 'A' + 'a');
  }
  return result;
}

std::size_t distance(std::string_view a, std::string_view b) {
  // Rows i - 1, i and i + 1 of the table of distances between the beginnings of both texts.
  std::vector<std::size_t> before(b.size() + 1);
  std::vector<std::size_t> row(b.size() + 1);
  std::vector<std::size_t> next(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    next[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      next[j + 1] = std::min({row[j] + (a[i] == b[j] ? 0 : 1), row[j + 1] + 1, next[j] + 1});
      if (i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j]) {
        next[j + 1] = std::min(next[j + 1], before[j - 1] + 1);
      }
    }
    std::swap(before, row);
    std::swap(row, next);
  }
  return row.back();
}

}  // namespace

NearestName::NearestName(std::string_view wrong)
    : wrong_(lower(wrong.substr(0, kMaxSuggestedBytes + 1))),
      distance_(std::numeric_limits<std::size_t>::max()) {}

void NearestName::consider(std::string_view candidate) {
  const std::size_t candidate_distance =
      distance(wrong_, lower(candidate.substr(0, kMaxSuggestedBytes)));
  if (candidate_distance >= distance_) return;
  distance_ = candidate_distance;
  nearest_ = candidate;
}

std::string NearestName::suggestion() const {
  const bool is_near = distance_ <= (wrong_.size() + 2) / 3;
  return wrong_.size() <= kMaxSuggestedBytes && is_near ? nearest_ : std::string();
}

Error with_suggestion(Error error, std::string name) {
  if (name.empty()) return error;
  error.message += "; did you mean \"" + name + "\"?";
  error.suggestion = std::move(name);
  return error;
}

}  // namespace vat
