#pragma once

#include <string>

#include "core/sampling/sampling.h"
#include "core/scene/scene.h"

/// Each overload returns the liquid body that results from melting a deformable body. The particles
/// and their masses are unchanged. Springs and fixed particles are removed.
namespace vat {

/// `mass` is the mass of the whole body [kg].
BodyDescription melted(BodyDescription body, const std::string& into, Real mass);
SampledBody melted(SampledBody sample);

/// Returns the scene with all bodies that will melt converted to liquid at time 0.
Scene with_all_melted(Scene scene, const std::vector<SampledBody>& samples);

}  // namespace vat
