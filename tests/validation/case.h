#pragma once

#include <functional>
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

inline constexpr Real kGravity = 9.81;  ///< standard of the reference cases [m/s^2]

struct Settings {
  bool quick = false;            ///< fewer or shorter runs, a few seconds a case
  TaskRunner* runner = nullptr;  ///< for all runs of the case; null: serial
};

/// What a case writes its results on.
class Sheet {
 public:
  explicit Sheet(const Settings& settings) : settings_(settings) {}

  bool quick() const { return settings_.quick; }
  TaskRunner* runner() const { return settings_.runner; }
  /// A run with the settings' runner.
  Run start(const Scene& scene) const { return Run(scene, settings_.runner); }

  /// Adds a row whose value came from `run`, as it is now.
  void add(std::string metric, Real reference, Real measured, Tolerance tolerance, const Run& run);
  /// Adds a row as it is, for values that came from several runs or from none.
  void add(Row row) { rows_.push_back(std::move(row)); }

  const std::vector<Row>& rows() const { return rows_; }

 private:
  Settings settings_;
  std::vector<Row> rows_;
};

/// One case: scenes, a metric and a reference. `run` throws std::exception where it cannot measure.
struct Case {
  std::string name;                 ///< as in the reference, "DEF-1"
  std::string title;                ///< one line for a reader
  std::string kind;                 ///< deformable, rigid, liquid or interaction
  std::vector<std::string> scenes;  ///< names of files of tests/validation/scenes
  std::function<void(Sheet&)> run;
};

/// What became of a case.
struct Outcome {
  std::string name;
  std::vector<Row> rows;
  std::optional<std::string> error;  ///< why it ended early

  bool passed() const;  ///< no error, at least one row, and all rows pass
};

Outcome run_case(const Case& one, const Settings& settings);

}  // namespace vat::validation
