#pragma once

#include <cstdint>
#include <string_view>

#include "core/evaluation/motion_probe.h"
#include "core/model/model.h"
#include "core/stage/advance_report.h"
#include "core/stage/context.h"
#include "core/stage/observer.h"
#include "core/state/state.h"

namespace vat {

/// Evaluates all forces: runs the model's plan.
struct ForceModel {
  const Model& model;
  const Controls& controls;
  Scratch& work;
  TaskRunner* runner = nullptr;
  StageObserver* observer = nullptr;
  std::uint64_t step = 0;           ///< the nominal step being taken
  AdvanceReport* report = nullptr;  ///< counts evaluations, if any
  MotionProbe* probe = nullptr;     ///< sees them, if any

  /// Tells the observer that `stage` begins.
  void enter(std::string_view stage) const {
    if (observer != nullptr) observer->stage_begins(stage);
  }
  /// Forces at `configuration` and `time`; also moves rigid particles to their poses.
  void evaluate(Configuration& configuration, Real time, Forces& forces) const;
};

}  // namespace vat
