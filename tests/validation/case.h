#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/scene/scene.h"
#include "core/support/parallel.h"
#include "tests/validation/row.h"
#include "tests/validation/run.h"

namespace vat::validation {

inline constexpr Real kGravity = 9.81;  ///< standard value of the reference cases [m/s^2]

struct Settings {
  bool quick = false;                    ///< fewer or shorter runs, a few seconds per case
  TaskRunner* runner = nullptr;          ///< for all runs of the case; null: serial
  std::optional<DeviceChoice> device{};  ///< for all runs that it supports; empty: the CPU
};

/// The results of a case.
class Sheet {
 public:
  explicit Sheet(const Settings& settings) : settings_(settings) {}

  bool quick() const { return settings_.quick; }
  /// Returns a run with the settings' runner and device. The next rows belong to the runs that
  /// start between the preceding row and them.
  Run start(const Scene& scene);

  /// Adds a row with a value of `run` in its present state.
  void add(std::string metric, Real reference, Real measured, Tolerance tolerance, const Run& run);
  /// Adds a complete row, for values of several runs or of none.
  void add(Row row);

  const std::vector<Row>& rows() const { return rows_; }

 private:
  Settings settings_;
  std::vector<Row> rows_;
  std::shared_ptr<DeviceUse> device_;  ///< of the runs of the next rows
  bool has_rows_ = false;              ///< rows of these runs
};

/// A validation case: scenes, metrics and references. `run` throws std::exception if it cannot
/// measure.
struct Case {
  std::string name;                 ///< as in the reference, "DEF-1"
  std::string title;                ///< one line for a reader
  std::string kind;                 ///< deformable, rigid, liquid or interaction
  std::vector<std::string> scenes;  ///< names of files in tests/validation/scenes
  std::function<void(Sheet&)> run;
};

/// Result of a case.
struct Outcome {
  std::string name;
  std::vector<Row> rows;
  std::optional<std::string> error;  ///< reason of an early end

  bool passed() const;  ///< no error, at least one row, and all rows pass
};

Outcome run_case(const Case& one, const Settings& settings);

}  // namespace vat::validation
