#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "core/support/parallel.h"
#include "core/support/result.h"
#include "protocol/tune/candidates.h"
#include "protocol/tune/motion.h"
#include "protocol/tune/search.h"

namespace vat::tune {

struct TuneSettings {
  Real until = 1;       ///< duration of the runs, rounded to whole ticks [s]
  int repetitions = 3;  ///< timed runs of the best candidates
  DropRule drops = DropRule::expected;
  TaskRunner* runner = nullptr;   ///< null: serial. Otherwise, it must outlive the tuning
  std::function<double()> clock;  ///< computing time since any start [s]
  std::function<bool()> stop = [] { return false; };
  /// Receives the name of the present stage, such as "reference run 1 of 2", and its progress.
  std::function<void(const std::string& stage, const Progress&)> show = [](const std::string&,
                                                                           const Progress&) {};
};

/// Division of a run into parts of equal length.
struct Parts {
  std::uint32_t count = 0;
  std::uint32_t ticks = 0;  ///< per part
  Real duration = 0;        ///< of all parts [s]
};
inline constexpr std::uint32_t kMostParts = 10;
/// Returns up to kMostParts parts of whole ticks, and a duration of about `until` [s].
Parts divide(Real until, Real tick);

/// Measurement of the candidates of one scene on this machine.
class Tuning {
 public:
  /// Runs both references of a valid scene. Fails if a reference run fails, or is stopped. Code:
  /// no_reference, interrupted.
  static Result<Tuning> create(const Scene& scene, const TuneSettings& settings);

  /// Runs the search, and returns the outcomes of candidates().
  std::vector<Outcome> search() const;
  std::vector<Point> points(const std::vector<Outcome>& outcomes) const;

  const CandidateSet& set() const { return set_; }
  const ErrorMeasure& measure() const { return measure_; }
  const Parts& parts() const { return parts_; }
  /// Replaces TuneSettings::drops.
  void set_drops(DropRule drops) { settings_.drops = drops; }

 private:
  Tuning(const Scene& scene, TuneSettings settings, CandidateSet set, ErrorMeasure measure,
         Parts parts, double most_seconds);
  SearchSettings search_settings() const;

  Scene scene_;
  TuneSettings settings_;
  CandidateSet set_;
  ErrorMeasure measure_;
  Parts parts_;
  double most_seconds_;  ///< of a run of a candidate
};

}  // namespace vat::tune
