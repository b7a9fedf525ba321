#pragma once

#include "core/contact/scratch.h"
#include "core/liquid/pairs/scratch.h"
#include "core/liquid/surface/scratch.h"
#include "core/solid/scratch.h"
#include "core/stage/scratch.h"

namespace vat {

/// The buffers of all methods of a step: each method has its lines here.
class Workspace : public Scratch {
 public:
  Workspace() { set_all(); }
  Workspace(const Workspace& other)
      : Scratch(other),
        liquid_(other.liquid_),
        surface_(other.surface_),
        contact_(other.contact_),
        solid_(other.solid_) {
    set_all();
  }

  /// Deletes all content, except the instruction set.
  void clear() {
    keep_dampers = false;
    liquid_ = {};
    surface_ = {};
    contact_ = {};
    solid_ = {};
  }

 private:
  void set_all() {
    set(liquid_);
    set(surface_);
    set(contact_);
    set(solid_);
  }

  LiquidScratch liquid_;
  SurfaceScratch surface_;
  ContactForceScratch contact_;
  SolidScratch solid_;
};

}  // namespace vat
