#pragma once

namespace vat {

/// Constants of surface tension by curvature; core/liquid/surface/surface_tension.h derives them.
inline constexpr double kSurfaceThreshold = 0.6;
inline constexpr double kCohesion = 4;
inline constexpr double kSurfaceDepth = 0.34;
inline constexpr double kSurfaceBulge = 0.105;

}  // namespace vat
