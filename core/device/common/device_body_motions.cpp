#include "core/device/common/device_body_motions.h"

#include <cmath>
#include <cstdint>
#include <span>

namespace vat {
namespace {

using opencl::Program;

/// Values of a body: the square of its greatest speed, its greatest coordinates, and its least
/// coordinates with the opposite sign.
constexpr std::size_t kValues = 7;

}  // namespace

DeviceBodyMotions::DeviceBodyMotions(Program& program, const Model& model, std::size_t first)
    : program_(program),
      bodies_(model.bodies.size()),
      has_free_bodies_(model.free_count > first),
      ranges_(program, bodies_ * 2 * sizeof(std::int32_t)),
      motions_(program, bodies_ * kValues * sizeof(double)) {
  std::vector<std::int32_t> ranges;
  for (const ModelBody& body : model.bodies) {
    const bool is_free = body.kind != BodyKind::rigid && body.particles.begin >= first;
    ranges.push_back(is_free ? static_cast<std::int32_t>(body.particles.begin - first) : 0);
    ranges.push_back(is_free ? static_cast<std::int32_t>(body.particles.end - first) : 0);
  }
  program.write(ranges_, std::span<const std::int32_t>(ranges));
}

std::size_t DeviceBodyMotions::bytes_for(const Model& model) {
  return model.bodies.size() * (2 * sizeof(std::int32_t) + kValues * sizeof(double));
}

void DeviceBodyMotions::read(const DeviceMotion& motion, std::vector<ParticleMotion>& motions) {
  motions.resize(bodies_);
  if (!has_free_bodies_) return;
  program_.run("find_body_motions", bodies_ * Program::kGroup, ranges_, motion.position,
               motion.velocity, motions_);
  read_.resize(bodies_ * kValues);
  program_.read(motions_, std::span(read_));
  for (std::size_t b = 0; b < bodies_; ++b) {
    const double* values = &read_[kValues * b];
    motions[b] = {std::sqrt(values[0]), -Vec3(values + 4), Vec3(values + 1)};
  }
}

}  // namespace vat
