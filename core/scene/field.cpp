#include "core/scene/field.h"

#include <cmath>

namespace vat {

Vec3 value_at(const VectorField& field, const Vec3& x) {
  Vec3 value = field.gradient * (x - field.center);
  for (const PlaneWave& wave : field.waves) {
    value += wave.amplitude * std::sin(wave.wave_vector.dot(x) + wave.phase);
  }
  return value;
}

}  // namespace vat
