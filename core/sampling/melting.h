#pragma once

#include <string>

#include "core/sampling/sampling.h"
#include "core/scene/scene.h"

/// What a deformable body becomes when it melts: the same particles with the same masses, without
/// springs, none of them fixed.
namespace vat {

/// `mass`: of the whole body [kg].
BodyDescription melted(BodyDescription body, const std::string& into, Real mass);
SampledBody melted(SampledBody sample);

/// The scene with all bodies melted that will, at time 0.
Scene with_all_melted(Scene scene, const std::vector<SampledBody>& samples);

}  // namespace vat
