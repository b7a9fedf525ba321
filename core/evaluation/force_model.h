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

/// Evaluates all forces by running the plan of the model, which lists the stages of an evaluation.
struct ForceModel {
  const Model& model;
  const Controls& controls;
  Scratch& work;
  TaskRunner* runner = nullptr;
  StageObserver* observer = nullptr;
  std::uint64_t step = 0;           ///< current nominal step
  AdvanceReport* report = nullptr;  ///< counter of evaluations; may be null
  MotionProbe* probe = nullptr;     ///< observer of evaluations; may be null

  /// Notifies the observer that `stage` begins.
  void enter(std::string_view stage) const {
    if (observer != nullptr) observer->stage_begins(stage);
  }
  /// Computes the forces at `configuration` and `time` [s]. Moves rigid particles to the poses of
  /// their bodies.
  void evaluate(Configuration& configuration, Real time, Forces& forces) const;
};

}  // namespace vat
