#pragma once

#include "core/scene/scene.h"
#include "core/types.h"

namespace vat {

/// The value of the field at the point `x` of the world.
Vec3 value_at(const VectorField& field, const Vec3& x);

}  // namespace vat
