#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <utility>

#include "core/support/result.h"

namespace vat {

/// Search for the valid name that is nearest to a wrong name. The distance is the number of letters
/// to insert, remove, replace, or exchange with the next letter (Damerau and Levenshtein, optimal
/// string alignment). Upper and lower case are equal.
class NearestName {
 public:
  explicit NearestName(std::string_view wrong);

  void consider(std::string_view candidate);
  /// Considers the projections of all elements.
  template <class Range, class Projection>
  NearestName& consider_all(const Range& range, const Projection& name_of) {
    for (const auto& element : range) consider(std::invoke(name_of, element));
    return *this;
  }

  /// Returns the first of the nearest candidates, or an empty text if there are no candidates.
  const std::string& nearest() const { return nearest_; }
  /// Returns nearest() if the user can have meant it, and otherwise an empty text. The distance is
  /// then at most a third of the wrong name's length, rounded up. Names longer than
  /// kMaxSuggestedBytes have no suggestion, because the search takes quadratic time.
  std::string suggestion() const;

  static constexpr std::size_t kMaxSuggestedBytes = 64;

 private:
  const std::string wrong_;
  std::string nearest_;
  std::size_t distance_;
};

/// Returns the error with `name` in `suggestion` and in the message. Returns the error unchanged if
/// `name` is empty.
Error with_suggestion(Error error, std::string name);

/// Number of errors of a document after which further errors have no suggestion. Limits the time
/// that a document with many wrong names takes.
inline constexpr std::size_t kMaxSuggestions = 16;

/// Returns an error unknown_name, with a suggestion from the projections of the elements. `earlier`
/// are the errors of the document so far.
template <class Range, class Projection>
Error unknown_name(const Errors& earlier, std::string path, std::string rule,
                   std::string_view wrong, const Range& range, const Projection& name_of) {
  Error error{"unknown_name", std::move(path), std::move(rule)};
  if (earlier.size() >= kMaxSuggestions) return error;
  return with_suggestion(std::move(error),
                         NearestName(wrong).consider_all(range, name_of).suggestion());
}

}  // namespace vat
