#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/support/parallel.h"
#include "core/support/result.h"
#include "tests/bench/report/table.h"

/// Error and time of the scenes of the catalogue with their own numerics.
namespace vat::bench {

struct CatalogueSettings {
  Real late = 1;              ///< time of the second error, a whole number of ticks [s]
  std::uint32_t refined = 8;  ///< factor between the steps of the scene and of the reference
  Real timed = 2;             ///< duration that is timed, a whole number of ticks [s]
  int repetitions = 5;        ///< of the timing
};

/// The error is the distance of the centres of mass of all bodies from those of a reference run,
/// relative to their displacement from the start. The reference has steps that are `refined` times
/// shorter, and tolerances of incompressible liquids of 10^-5.
struct CatalogueResult {
  std::string scene;
  std::string pressure_solver;  ///< of its liquids; empty without liquids
  std::size_t particles = 0;    ///< at the start
  Real step = 0;                ///< [s]
  Real early_error = 0;         ///< at kEarly
  Real late_error = 0;
  double speed = 0;  ///< simulated time / wall time, median
};

inline constexpr Real kEarly = 0.3;  ///< [s]

/// Measures all scenes of the catalogue, in the order of their names.
std::vector<CatalogueResult> measure_catalogue(const CatalogueSettings& settings,
                                               TaskRunner* runner);

Table catalogue_table(const std::vector<CatalogueResult>& results);

/// Writes the table to `folder`.
Status write_catalogue(const std::vector<CatalogueResult>& results,
                       const std::filesystem::path& folder);

}  // namespace vat::bench
