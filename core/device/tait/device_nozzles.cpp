#include "core/device/tait/device_nozzles.h"

#include "core/device/common/kernel_values.h"

namespace vat {
namespace {

std::vector<std::int32_t> particles_in_tubes(const Model& model) {
  std::vector<std::int32_t> particles;
  for (std::size_t i = 0; i < model.liquid_count; ++i) {
    if (model.inverse_mass[i] == 0) particles.push_back(number_of(i));
  }
  return particles;
}

}  // namespace

bool DeviceNozzles::has_particles(const Model& model) {
  return !particles_in_tubes(model).empty();
}

DeviceNozzles::DeviceNozzles(opencl::Program& program, const Model& model)
    : program_(program),
      particles_(particles_in_tubes(model)),
      buffer_(program, particles_.size() * sizeof(std::int32_t)) {
  program.write(buffer_, std::span(particles_));
}

std::size_t DeviceNozzles::bytes_for(const Model& model) {
  return particles_in_tubes(model).size() * sizeof(std::int32_t);
}

void DeviceNozzles::hold(const opencl::Buffer& acceleration) {
  program_.run("hold_particles", particles_.size(), number_of(particles_.size()), buffer_,
               acceleration);
}

}  // namespace vat
