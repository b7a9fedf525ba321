#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/types.h"
#include "protocol/tune/front.h"

/// Search for the candidates on the Pareto front of time and error. The search knows neither scenes
/// nor clocks: tests use trials with controlled times and errors.
namespace vat::tune {

/// Part of a run between two moments.
struct Segment {
  double seconds = 0;  ///< computing time
  Real bound = 0;      ///< lower bound of the error; the error itself at the last moment
  std::uint64_t steps = 0;
  std::uint64_t iterations = 0;
};

/// Run of one candidate.
class Trial {
 public:
  virtual ~Trial() = default;
  /// Runs to the next moment, or until the computing time of this part exceeds `most_seconds`.
  /// Returns nothing if the run failed.
  virtual std::optional<Segment> advance(double most_seconds) = 0;
  /// Reduces memory until the next call of advance().
  virtual void suspend() {}
};

/// Returns a new run of a candidate from the start.
using StartTrial = std::function<std::unique_ptr<Trial>(std::size_t candidate)>;

/// Progress of a search, for the user.
struct Progress {
  std::size_t completed = 0;  ///< runs that have ended, including dropped candidates
  std::size_t runs = 0;
  double remaining = 0;  ///< estimated computing time [s]
};

/// Condition for ending the run of a candidate early.
enum class DropRule : std::uint8_t {
  expected,  ///< the expected time and the error so far are worse than those of another candidate
  proven,    ///< the time and the error so far exceed those of a completed run
  never,
};

struct SearchSettings {
  std::size_t candidates = 0;
  std::size_t moments = 10;  ///< per run
  std::size_t probe = 3;     ///< number of moments that all candidates run before any is completed
  double duration = 1;       ///< of a run [s]
  int repetitions = 3;       ///< timed runs of the best candidates
  DropRule drops = DropRule::expected;
  double most_seconds = std::numeric_limits<double>::infinity();  ///< of a run; see search()
  Real floor = 0;                                     ///< errors below it count as this value
  std::function<bool()> stop = [] { return false; };  ///< true: ends the search
  std::function<void(const Progress&)> show = [](const Progress&) {};
};

enum class OutcomeKind : std::uint8_t { waiting, completed, dropped, failed };

/// Result of one candidate.
struct Outcome {
  OutcomeKind kind = OutcomeKind::waiting;
  /// Medians over the runs of this candidate, by part. All parts if the run is complete.
  std::vector<Segment> segments;
  std::optional<std::size_t> dominated_by{};  ///< reason for `dropped`; none: it is too slow

  double seconds() const;  ///< total computing time
};

/// A candidate is dropped if another one is faster at the same moment by this factor, and has an
/// error that is smaller by kErrorMargin.
/// With an error margin of 2, the search dropped candidates on the front of dam-break and honey.
inline constexpr double kTimeMargin = 1.25;
inline constexpr Real kErrorMargin = 8;
/// The first part can have other steps and iterations than the rest of the run. Comparisons after
/// the first part dropped candidates on the front of deep-tank.
inline constexpr std::size_t kFirstComparison = 2;

/// Runs candidates 0 to settings.candidates - 1, and returns their outcomes:
///
/// 1. Every candidate runs to moment `probe`.
/// 2. The candidates are completed by ascending expected time.
/// 3. The candidates on the front, and those whose time exceeds the front by at most kTimeMargin,
///    run again, alternately. Their times are medians.
///
/// After each part of a run, the rule `expected` drops a candidate c if another candidate d
///
/// - is better at the same moment: time(d) kTimeMargin <= time(c) and error(d) kErrorMargin <=
///   error(c). This moment is at least kFirstComparison; or
/// - is completed, its error is at most the lower bound of the error of c, and its time is at most
///   the present time of c, or the expected time of c divided by kTimeMargin.
///
/// The rule `proven` drops a candidate c if all of these conditions hold for a completed candidate
/// d. Without a variation of times by kTimeMargin, no choice can be c.
///
/// - error(d) is at most the lower bound of error(c).
/// - time(d) kTimeMargin is at most the time of c so far.
/// - The time of the slowest part of d, times kTimeMargin, is at most that of c so far.
///
/// Both rules also drop a candidate whose time exceeds `most_seconds`.
///
/// All errors are at least the floor.
std::vector<Outcome> search(const SearchSettings& settings, const StartTrial& start);

/// Returns the completed outcomes as points.
std::vector<Point> points_of(const std::vector<Outcome>& outcomes, const SearchSettings& settings);

}  // namespace vat::tune
