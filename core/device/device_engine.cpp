#include "core/device/device_engine.h"

#include <string>

#include "core/device/common/arithmetic_check.h"
#include "core/device/common/kernel_values.h"
#include "core/device/gas/gas_method.h"
#include "core/device/incompressible/incompressible_method.h"
#include "core/device/kernel_source.h"
#include "core/device/opencl/program.h"
#include "core/device/solid/solid_method.h"
#include "core/device/supported.h"
#include "core/device/tait/tait_method.h"
#include "core/support/check.h"

namespace vat {
namespace {

using opencl::DeviceFailure;
using opencl::Program;

Error failed(const std::string& message) {
  return {"device_failed", "/device", message};
}

/// The steps of one kind of scenes.
struct MethodKind {
  std::size_t (*bytes_for)(const Model& model);
  std::unique_ptr<DeviceMethod> (*make)(Program& program, std::shared_ptr<const Model> model,
                                        const GuardBounds& bounds);
};

// Scenes with these solvers have no sleeping bodies, so that the bounds follow from the model.
std::unique_ptr<DeviceMethod> make_tait(Program& program, std::shared_ptr<const Model> model,
                                        const GuardBounds&) {
  return make_tait_method(program, std::move(model));
}

std::unique_ptr<DeviceMethod> make_incompressible(Program& program,
                                                  std::shared_ptr<const Model> model,
                                                  const GuardBounds&) {
  return make_incompressible_method(program, std::move(model));
}

MethodKind kind_of(const Model& model) {
  if (model.liquid_count == 0) return {&bytes_for_solids, &make_solid_method};
  if (!model.is_coupled) return {&bytes_for_gas, &make_gas_method};
  if (model.is_incompressible) return {&bytes_for_incompressible, &make_incompressible};
  return {&bytes_for_tait, &make_tait};
}

std::string lanes_option(const opencl::Device& device) {
  return " -DLANES=" + std::to_string(device.lanes);
}

/// The options of kernels by which the programs of scenes differ.
struct ProgramKind {
  KernelId kernel = KernelId::wendland_c2;
  bool is_double = false;          ///< sums over pairs
  bool has_table = false;          ///< of liquids
  bool has_contact_terms = false;  ///< layers and restitution

  bool operator==(const ProgramKind&) const = default;
};

ProgramKind program_for(const Model& model) {
  return {model.scene.kernel, has_double_pairs(model), has_table_of_liquids(model),
          has_contact_terms(model)};
}

class DeviceEngine : public StepEngine {
 public:
  /// `options` are those of `program`, which has the kind ProgramKind{}.
  DeviceEngine(std::unique_ptr<Program> program, std::string options, DeviceArithmetic arithmetic)
      : device_(program->device()),
        options_(std::move(options)),
        program_(std::move(program)),
        name_("opencl-" + std::string(to_string(arithmetic))) {}

  std::string_view arithmetic() const override { return name_; }
  Status bind(std::shared_ptr<const Model> model, const GuardBounds& bounds) override;
  Result<bool> advance(const EngineInput& input, std::uint32_t steps) override;
  Status read(State& state) override;
  Status read_motions(BodyMotions& motions) override;

 private:
  /// Creates the program for a scene, if the present program is for others.
  Status adapt_program(const Model& model);

  const opencl::Device device_;
  const std::string options_;
  ProgramKind kind_;  ///< of program_
  std::unique_ptr<Program> program_;
  std::string name_;
  std::unique_ptr<DeviceMethod> method_;  ///< of the bound model
};

Status DeviceEngine::adapt_program(const Model& model) {
  const ProgramKind kind = program_for(model);
  if (kind == kind_) return {};
  std::string options = options_;
  opencl::Device device = device_;
  if (kind.kernel == KernelId::cubic_spline) options += " -DVAT_CUBIC_SPLINE";
  if (kind.is_double) options += " -DVAT_DOUBLE_PAIRS";
  if (kind.has_table) options += " -DVAT_SEVERAL_LIQUIDS";
  if (kind.has_contact_terms) options += " -DVAT_CONTACT_TERMS";
  if (kind.is_double || kind.has_table) device.lanes = 1;  // vectors have neither
  options += lanes_option(device);
  Result<std::unique_ptr<Program>> program =
      Program::create(device, device_kernels(), options, kind.is_double);
  if (!program) return program.errors();
  program_ = std::move(program).value();
  kind_ = kind;
  return {};
}

Status DeviceEngine::bind(std::shared_ptr<const Model> model, const GuardBounds& bounds) {
  method_.reset();  // before the allocation of new buffers
  // The CPU takes the steps until the first particles enter.
  if (model->liquid_count == 0 && !model->nozzles.empty()) return {};
  Errors missing = find_features_not_on_device(*model);
  if (!missing.empty()) return missing;
  if (Status adapted = adapt_program(*model); !adapted) return adapted;
  const MethodKind kind = kind_of(*model);
  const std::size_t bytes = kind.bytes_for(*model);
  const opencl::Device& device = program_->device();
  const std::uint64_t used = *device.used_memory;
  if (bytes > device.memory || used > device.memory - bytes) {
    return failed("the scene needs " + std::to_string(bytes) + " bytes on the device; " +
                  device.name + " has " + std::to_string(device.memory) + " bytes, of which " +
                  std::to_string(used) + " are in use");
  }
  try {
    method_ = kind.make(*program_, std::move(model), bounds);
  } catch (const DeviceFailure& failure) {
    return failed(failure.what());
  }
  return {};
}

Result<bool> DeviceEngine::advance(const EngineInput& input, std::uint32_t steps) {
  VAT_CHECK(steps > 0);
  if (method_ == nullptr) return false;
  if (!input.controls.grabs.empty() || !input.controls.applied_forces.empty()) return false;
  try {
    return method_->take_steps(input, steps);
  } catch (const DeviceFailure& failure) {
    return failed(failure.what());
  }
}

Status DeviceEngine::read_motions(BodyMotions& motions) {
  VAT_CHECK(method_ != nullptr);
  try {
    method_->read_motions(motions);
  } catch (const DeviceFailure& failure) {
    return failed(failure.what());
  }
  return {};
}

Status DeviceEngine::read(State& state) {
  VAT_CHECK(method_ != nullptr);
  try {
    method_->read(state);
  } catch (const DeviceFailure& failure) {
    return failed(failure.what());
  }
  return {};
}

}  // namespace

Result<std::unique_ptr<StepEngine>> make_device_engine(const opencl::Device& device,
                                                       DeviceArithmetic arithmetic) {
  std::string options = "-cl-std=CL1.2";
  if (arithmetic == DeviceArithmetic::exact) {
    if (!device.is_exact) {
      return Error{"not_available", "/device",
                   device.name + " has no exact arithmetic; use the arithmetic fast"};
    }
    options += " -DVAT_EXACT -cl-fp32-correctly-rounded-divide-sqrt";
  }
  Result<std::unique_ptr<Program>> program =
      Program::create(device, device_kernels(), options + lanes_option(device));
  if (!program) return program.errors();
  if (arithmetic == DeviceArithmetic::exact) {
    try {
      if (Status exact = test_arithmetic(*program.value()); !exact) return exact.errors();
    } catch (const DeviceFailure& failure) {
      return failed(failure.what());
    }
  }
  return std::unique_ptr<StepEngine>(
      new DeviceEngine(std::move(program).value(), options, arithmetic));
}

}  // namespace vat
