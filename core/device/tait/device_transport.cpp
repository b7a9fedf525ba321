#include "core/device/tait/device_transport.h"

#include <cmath>
#include <span>

#include "core/device/common/kernel_values.h"
#include "core/liquid/pairs/coupled_pairs.h"
#include "core/support/check.h"

namespace vat {
namespace {

using opencl::Program;

TransportParameters transport_parameters(const Model& model) {
  const LiquidModel& liquid = *model.liquids[model.material[0]];
  const Real gradient = slope_factor(model, liquid);
  const Real strength = -(std::sqrt(liquid.stiffness) * liquid.spacing / 6) * gradient;
  return {static_cast<float>(gradient), static_cast<float>(strength)};
}

}  // namespace

DeviceTransport::DeviceTransport(Program& program, const Model& model)
    : program_(program),
      count_(model.liquid_count),
      parameters_(transport_parameters(model)),
      transport_(program, count_ * sizeof(Float4)),
      saved_(program, count_ * sizeof(Float4)),
      sorted_(program, model.particle_count * sizeof(Float4)) {
  VAT_CHECK(model.is_filled);
}

std::size_t DeviceTransport::bytes_for(const Model& model) {
  return (2 * model.liquid_count + model.particle_count) * sizeof(Float4);
}

void DeviceTransport::write(const Forces& from) {
  std::vector<Float4> transport(count_);
  for (std::size_t i = 0; i < from.transport.size(); ++i) {
    const Vec3& w = from.transport[i];
    transport[i] = {static_cast<float>(w.x()), static_cast<float>(w.y()), static_cast<float>(w.z()),
                    0};
  }
  program_.write(transport_, std::span<const Float4>(transport));
}

void DeviceTransport::read() {
  read_.resize(count_);
  program_.read(transport_, std::span<Float4>(read_));
}

void DeviceTransport::copy_to(Forces& to) const {
  to.transport.clear();
  for (const Float4& w : read_) {
    to.transport.emplace_back(static_cast<Real>(w.x), static_cast<Real>(w.y),
                              static_cast<Real>(w.z));
  }
}

void DeviceTransport::save() {
  program_.copy(transport_, saved_, count_ * sizeof(Float4));
}

void DeviceTransport::restore() {
  program_.copy(saved_, transport_, count_ * sizeof(Float4));
}

void DeviceTransport::drift(Real dt, const opencl::Buffer& position) {
  program_.run("drift_with_transport", count_, number_of(count_), dt, transport_, position);
}

void DeviceTransport::add_forces(const LiquidParameters& p, const DeviceParticles& s,
                                 const opencl::Buffer& acceleration) {
  program_.run("find_transport", s.count(), p, parameters_, s.cells.begins, s.order, s.sorted_place,
               s.neighbour_counts, s.neighbours, sorted_, transport_);
  program_.run("add_transport_forces", s.count(), p, parameters_, s.cells.begins, s.order,
               s.sorted_place, s.sorted_motion, s.neighbour_counts, s.neighbours, sorted_,
               acceleration);
}

}  // namespace vat
