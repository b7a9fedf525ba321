#pragma once

#include <cstdint>

#include "core/stage/scratch.h"
#include "core/support/parallel.h"
#include "core/types.h"

namespace vat {

struct Configuration;
struct Controls;
struct Forces;
struct Model;

/// The arguments of a stage function; see Stage.
struct StepContext {
  const Model& model;
  const Controls& controls;
  Real time;           ///< [s]
  std::uint64_t step;  ///< index of the current nominal step
  Configuration& configuration;
  Forces& forces;
  Scratch& work;
  TaskRunner* runner;
};

}  // namespace vat
