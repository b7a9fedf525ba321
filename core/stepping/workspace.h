#pragma once

#include <tuple>

#include "core/contact/scratch.h"
#include "core/liquid/incompressible/volume_solve.h"
#include "core/liquid/pairs/scratch.h"
#include "core/liquid/surface/scratch.h"
#include "core/solid/scratch.h"
#include "core/stage/scratch.h"

namespace vat {

/// The buffers of all methods of a step.
class Workspace : public Scratch {
 public:
  Workspace() { set_all(); }
  Workspace(const Workspace& other) : Scratch(other), buffers_(other.buffers_) { set_all(); }

  /// Clears all members except the instruction set.
  void clear() {
    keep_dampers = false;
    buffers_ = {};
  }

 private:
  void set_all() {
    std::apply([&](auto&... buffers) { (set(buffers), ...); }, buffers_);
  }

  std::tuple<LiquidScratch, SurfaceScratch, ContactForceScratch, SolidScratch, VolumeScratch>
      buffers_;
};

}  // namespace vat
