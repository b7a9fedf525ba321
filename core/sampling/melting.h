#pragma once

#include <string>

#include "core/sampling/sampling.h"
#include "core/scene/scene.h"

/// The liquid body into which a deformable body melts: the same particles with the same masses,
/// without springs and fixed particles.
namespace vat {

/// `mass`: of the whole body [kg].
BodyDescription melted(BodyDescription body, const std::string& into, Real mass);
SampledBody melted(SampledBody sample);

/// The scene in which all bodies that will melt are liquid at time 0.
Scene with_all_melted(Scene scene, const std::vector<SampledBody>& samples);

}  // namespace vat
