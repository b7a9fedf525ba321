#include "core/device/gas/gas_method.h"

#include <utility>

#include "core/device/gas/device_gas.h"
#include "core/device/solid/solid_method.h"
#include "core/guard/guard.h"

namespace vat {
namespace {

using opencl::Program;

class GasMethod : public SolidMethod {
 public:
  GasMethod(Program& program, std::shared_ptr<const Model> liquids, const GuardBounds& bounds)
      : SolidMethod(program, std::move(liquids), bounds), gas_(program, model()) {}

 private:
  void evaluate(const StepMoment& start, Real end) override;

  DeviceGas gas_;
};

void GasMethod::evaluate(const StepMoment& start, Real end) {
  move(start, end);
  solids().find_forces(end);
  gas_.add_forces(model(), solids(), end);
  solids().gather();
}

}  // namespace

std::size_t bytes_for_gas(const Model& model) {
  return bytes_for_solids(model) + DeviceGas::bytes_for(model);
}

std::unique_ptr<DeviceMethod> make_gas_method(Program& program, std::shared_ptr<const Model> model,
                                              const GuardBounds& bounds) {
  return std::make_unique<GasMethod>(program, std::move(model), bounds);
}

}  // namespace vat
