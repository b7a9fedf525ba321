#pragma once

#include <bit>
#include <cstdint>
#include <span>

#include "core/device/opencl/program.h"
#include "core/liquid/pairs/coupled_pairs.h"
#include "core/model/model.h"
#include "core/scene/scene.h"
#include "core/types.h"

/// Conversions to arguments of kernels.
namespace vat {

/// A vector of four numbers in double precision of a kernel.
struct Double4 {
  double x, y, z, w;
};

inline void store(const Vec3& from, double (&to)[3]) {
  for (int k = 0; k < 3; ++k) to[k] = from[k];
}
inline void store(const Vec3& from, float (&to)[3]) {
  for (int k = 0; k < 3; ++k) to[k] = static_cast<float>(from[k]);
}

/// Stores the rows one after the other.
inline void store(const Mat3& from, double (&to)[9]) {
  for (int k = 0; k < 9; ++k) to[k] = from(k / 3, k % 3);
}
/// Stores x, y, z and w.
inline void store(const Quat& from, double (&to)[4]) {
  for (int k = 0; k < 4; ++k) to[k] = from.coeffs()[k];
}

/// Stores the central field that acts in a scene, if any.
template <class Parameters>
void store_central_field(const Scene& scene, Parameters& parameters) {
  if (!scene.forces.gravity || !scene.central_field) return;
  const CentralField& field = *scene.central_field;
  store(field.center, parameters.field_center);
  parameters.field_strength = field.angular_frequency * field.angular_frequency;
}

/// Returns whether sums over pairs of liquids are in double precision.
inline bool has_double_pairs(const Model& model) {
  return model.is_coupled && model.scene.pair_precision == PairPrecision::double_precision;
}
/// Returns whether the kernels of tait have a table of liquids.
inline bool has_table_of_liquids(const Model& model) {
  return model.is_coupled && !model.is_incompressible && has_several_liquids(model);
}
/// Returns whether the kernels of contacts have the terms of layers and restitution.
inline bool has_contact_terms(const Model& model) {
  return model.has_layers || model.has_restitution;
}
/// Returns the bytes of a number in the precision of these sums.
inline std::size_t bytes_of_real(const Model& model) {
  return has_double_pairs(model) ? sizeof(double) : sizeof(float);
}

/// Returns a number rounded to 50 bits, see particles.cl.
inline double without_last_bits(double a) {
  return std::bit_cast<double>((std::bit_cast<std::int64_t>(a) + 4) & ~std::int64_t{7});
}

/// Write and read numbers in the precision of the sums over pairs of the program.
void write_reals(opencl::Program& program, const opencl::Buffer& buffer,
                 std::span<const double> values);
void read_reals(opencl::Program& program, const opencl::Buffer& buffer, std::span<double> values);

/// Returns a count as an argument of a kernel.
inline std::int32_t number_of(std::size_t count) {
  return static_cast<std::int32_t>(count);
}

/// Returns the number of groups of work-items for `particles`, each of which has a partial result.
inline std::int32_t groups_of(std::size_t particles) {
  constexpr std::size_t kGroup = opencl::Program::kGroup;
  return static_cast<std::int32_t>((particles + kGroup - 1) / kGroup);
}

/// Returns the bytes of one Double4 for each of these groups.
inline std::size_t bytes_of_partial(std::size_t particles) {
  return static_cast<std::size_t>(groups_of(particles)) * sizeof(Double4);
}

}  // namespace vat
