#pragma once

#include <functional>
#include <string>

#include "core/scene/scene.h"
#include "protocol/tune/tuning.h"
#include "tests/bench/report/table.h"

namespace vat::bench {

/// Comparison of the search with the exhaustive search, for one scene. A ratio is that of the
/// chosen candidate to the best one, both with the figures of the exhaustive search.
struct TuneResultRow {
  std::string scene;
  std::size_t candidates = 0;
  std::size_t dropped = 0;
  std::size_t front = 0;             ///< number of points on the exhaustive front
  Real noise = 0;                    ///< floor of errors
  Real own_error = kAbsent;          ///< of the numerics of the scene
  double own_seconds = kAbsent;      ///< per simulated second
  double worst_time = kAbsent;       ///< greatest ratio of times over all errors on the front
  double real_time_error = kAbsent;  ///< ratio of errors for real time; absent: none is fast enough
  double search_seconds = 0;         ///< computing time of the search, with the references
  double exhaustive_seconds = 0;     ///< the same, exhaustive
};

/// Compares a search with an exhaustive search of the same candidates.
TuneResultRow compare_searches(const std::string& name, const tune::Tuning& tuning,
                               const std::vector<tune::Outcome>& searched,
                               const std::vector<tune::Outcome>& all);

Table tune_table(const std::vector<TuneResultRow>& rows);

}  // namespace vat::bench
