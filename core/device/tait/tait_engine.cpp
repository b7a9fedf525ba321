#include "core/device/tait/tait_engine.h"

#include <string>
#include <vector>

#include "core/damping/damping_solve.h"
#include "core/device/opencl/program.h"
#include "core/device/tait/kernel_source.h"
#include "core/device/tait/parameters.h"
#include "core/device/tait/supported.h"
#include "core/support/check.h"

namespace vat {
namespace {

using opencl::Buffer;
using opencl::DeviceFailure;
using opencl::Program;

// Constants of step.cl.
constexpr std::size_t kScanBlock = 1024;
constexpr std::size_t kListLength = 64;
constexpr std::size_t kListGroup = 32;

/// A vector of four numbers of a kernel.
struct Float4 {
  float x, y, z, w;
};

/// Counters of the kernels, in the order of step.cl.
struct Counters {
  std::int32_t faults = 0;
  std::int32_t stops = 0;
};

/// The integrated variables, in the order of particles.
struct StateBuffers {
  Buffer position, velocity, acceleration;
};

struct Buffers {
  StateBuffers now;
  StateBuffers start;  ///< state before a call, for a failed step
  Buffer weight;       // in the order of particles
  Buffer place, motion, cell_of, rank;
  Buffer unsorted, order, sorted_place, sorted_motion;  // in the order of cells
  Buffer neighbour_counts, neighbours;
  Buffer cell_counts, cell_begins, block_sums;
  Buffer counters;
};

std::size_t list_entries(std::size_t particles) {
  return (particles + kListGroup - 1) / kListGroup * kListGroup * kListLength;
}

std::size_t bytes_for(std::size_t particles, std::size_t cells) {
  return particles * (12 * sizeof(double) + 6 * sizeof(Float4) + 6 * sizeof(std::int32_t)) +
         list_entries(particles) * sizeof(std::uint32_t) + cells * 2 * sizeof(std::int32_t);
}

class TaitEngine : public StepEngine {
 public:
  TaitEngine(std::unique_ptr<Program> program, DeviceArithmetic arithmetic)
      : program_(std::move(program)), name_("opencl-" + std::string(to_string(arithmetic))) {}

  std::string_view arithmetic() const override { return name_; }
  Status bind(std::shared_ptr<const Model> model) override;
  Result<bool> advance(const EngineInput& input, std::uint32_t steps) override;
  Status read(State& state) override;

 private:
  void allocate();
  void upload(const State& state);
  void evaluate(const TaitParameters& p);
  void copy(const StateBuffers& from, const StateBuffers& to);
  bool take_steps(const EngineInput& input, std::uint32_t steps);

  std::unique_ptr<Program> program_;
  std::string name_;
  std::shared_ptr<const Model> model_;
  std::optional<TaitGeometry> geometry_;
  Buffers on_device_;
  std::vector<Vec3> positions_;
  std::vector<Vec3> velocities_;
  std::vector<Float4> accelerations_;
};

Status TaitEngine::bind(std::shared_ptr<const Model> model) {
  model_.reset();
  Errors missing = find_features_not_on_device(*model);
  if (!missing.empty()) return missing;
  geometry_.emplace(*model, guard_bounds(*model));
  const std::size_t bytes = bytes_for(model->particle_count, geometry_->cell_count());
  if (bytes > program_->device().memory) {
    return Error{"device_failed", "/device",
                 "the scene needs " + std::to_string(bytes) + " bytes on the device; " +
                     program_->device().name + " has " + std::to_string(program_->device().memory)};
  }
  model_ = std::move(model);
  try {
    allocate();
  } catch (const DeviceFailure& failure) {
    model_.reset();
    return Error{"device_failed", "/device", failure.what()};
  }
  return {};
}

void TaitEngine::allocate() {
  on_device_ = {};  // before the allocation of the new buffers
  const std::size_t n = model_->particle_count;
  const std::size_t cells = geometry_->cell_count();
  const auto buffer = [&](std::size_t count, std::size_t size) {
    return Buffer(*program_, count * size);
  };
  const std::size_t number = sizeof(std::int32_t);
  const auto state = [&] {
    return StateBuffers{buffer(3 * n, sizeof(double)), buffer(3 * n, sizeof(double)),
                        buffer(n, sizeof(Float4))};
  };
  on_device_ = {state(),
                state(),
                buffer(n, sizeof(float)),
                buffer(n, sizeof(Float4)),
                buffer(n, sizeof(Float4)),
                buffer(n, number),
                buffer(n, number),
                buffer(n, number),
                buffer(n, number),
                buffer(n, sizeof(Float4)),
                buffer(n, sizeof(Float4)),
                buffer(n, number),
                buffer(list_entries(n), number),
                buffer(cells, number),
                buffer(cells + 1, number),
                buffer((cells + kScanBlock - 1) / kScanBlock, number),
                buffer(1, sizeof(Counters))};
  const Real scale = model_->liquids[model_->material[0]]->kernel.scale();
  std::vector<float> weights;
  for (const Real volume : model_->rest_volume) {
    weights.push_back(static_cast<float>(volume * scale));
  }
  program_->write(on_device_.weight, std::span<const float>(weights));
}

void TaitEngine::upload(const State& state) {
  const std::size_t n = model_->particle_count;
  VAT_CHECK(state.now.position.size() == n && state.now.velocity.size() == n);
  static_assert(sizeof(Vec3) == 3 * sizeof(double));
  program_->write(on_device_.now.position, std::span<const Vec3>(state.now.position));
  program_->write(on_device_.now.velocity, std::span<const Vec3>(state.now.velocity));
  accelerations_.assign(n, {});
  if (state.forces_current) {
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3 a = state.forces.particle[i] * model_->inverse_mass[i];
      accelerations_[i] = {static_cast<float>(a.x()), static_cast<float>(a.y()),
                           static_cast<float>(a.z()), 0};
    }
  }
  program_->write(on_device_.now.acceleration, std::span<const Float4>(accelerations_));
}

Status TaitEngine::read(State& state) {
  VAT_CHECK(model_ != nullptr);
  const std::size_t n = model_->particle_count;
  positions_.resize(n);
  velocities_.resize(n);
  accelerations_.resize(n);
  try {
    program_->read(on_device_.now.position, std::span<Vec3>(positions_));
    program_->read(on_device_.now.velocity, std::span<Vec3>(velocities_));
    program_->read(on_device_.now.acceleration, std::span<Float4>(accelerations_));
  } catch (const DeviceFailure& failure) {
    return Error{"device_failed", "/device", failure.what()};
  }
  state.now.position.swap(positions_);
  state.now.velocity.swap(velocities_);
  state.forces.particle.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Float4& a = accelerations_[i];
    state.forces.particle[i] =
        model_->mass[i] *
        Vec3(static_cast<Real>(a.x), static_cast<Real>(a.y), static_cast<Real>(a.z));
  }
  state.forces_current = true;
  state.bound = model_->damping.any ? find_bound_of_bodies(*model_) : Oscillation{};
  return {};
}

void TaitEngine::copy(const StateBuffers& from, const StateBuffers& to) {
  const std::size_t n = model_->particle_count;
  program_->copy(from.position, to.position, 3 * n * sizeof(double));
  program_->copy(from.velocity, to.velocity, 3 * n * sizeof(double));
  program_->copy(from.acceleration, to.acceleration, n * sizeof(Float4));
}

/// Moves the particles, and computes their accelerations at the new positions.
void TaitEngine::evaluate(const TaitParameters& p) {
  const std::size_t n = model_->particle_count;
  const std::size_t cells = geometry_->cell_count();
  const auto cell_count = static_cast<std::int32_t>(cells);
  const std::size_t blocks = (cells + kScanBlock - 1) / kScanBlock;
  const std::size_t scanners = blocks * Program::kGroup;
  Program& run = *program_;
  Buffers& b = on_device_;
  run.fill_with_zeros(b.cell_counts, cells * sizeof(std::int32_t));
  run.run("move", n, p, b.now.position, b.now.velocity, b.now.acceleration, b.weight, b.place,
          b.motion, b.cell_of, b.rank, b.cell_counts, b.counters);
  run.run("sum_blocks", scanners, cell_count, b.cell_counts, b.block_sums);
  run.run("scan_sums", Program::kGroup, static_cast<std::int32_t>(blocks), b.block_sums);
  run.run("scan_blocks", scanners, cell_count, b.cell_counts, b.block_sums, b.cell_begins);
  run.run("scatter", n, p.count, b.cell_of, b.rank, b.cell_begins, b.unsorted);
  run.run("collect", n, p.count, b.cell_of, b.cell_begins, b.unsorted, b.place, b.motion, b.order,
          b.sorted_place, b.sorted_motion);
  run.run("find_pressure", n, p, b.cell_begins, b.sorted_place, b.sorted_motion, b.neighbour_counts,
          b.neighbours);
  run.run("find_acceleration", n, p, b.cell_begins, b.order, b.sorted_place, b.sorted_motion,
          b.neighbour_counts, b.neighbours, b.now.acceleration);
}

bool TaitEngine::take_steps(const EngineInput& input, std::uint32_t steps) {
  const State& state = input.state;
  const Real dt = model_->scene.numerics.step;
  if (!input.continues) upload(state);
  copy(on_device_.now, on_device_.start);
  program_->fill_with_zeros(on_device_.counters, sizeof(Counters));
  std::uint32_t evaluations = steps;
  if (!input.continues && !state.forces_current) {
    const Real start = static_cast<Real>(state.step_count) * dt;
    evaluate(geometry_->at(*model_, {start, 0, 0, 0, 0}));
    ++evaluations;
  }
  TaitMoment moment{0, 0, dt / 2, dt, model_->damping.any ? dt / 2 : 0};
  for (std::uint32_t s = 0; s < steps; ++s) {
    moment.time = static_cast<Real>(state.step_count + s) * dt + dt;
    evaluate(geometry_->at(*model_, moment));
    moment.closing = dt / 2;
  }
  program_->run("finish", model_->particle_count, geometry_->at(*model_, moment),
                on_device_.now.position, on_device_.now.velocity, on_device_.now.acceleration,
                on_device_.counters);
  Counters counters;
  program_->read(on_device_.counters, std::span(&counters, 1));
  if (counters.faults != 0) {
    copy(on_device_.start, on_device_.now);
    return false;
  }
  AdvanceReport& report = input.report;
  for (std::uint32_t e = 0; e < evaluations; ++e) report.count_evaluation(model_->particle_count);
  report.count_steps(steps, dt, dt);
  report.wall_stops += static_cast<std::uint64_t>(counters.stops);
  return true;
}

Result<bool> TaitEngine::advance(const EngineInput& input, std::uint32_t steps) {
  VAT_CHECK(model_ != nullptr && steps > 0);
  if (!input.controls.grabs.empty() || !input.controls.applied_forces.empty()) return false;
  try {
    return take_steps(input, steps);
  } catch (const DeviceFailure& failure) {
    return Error{"device_failed", "/device", failure.what()};
  }
}

}  // namespace

Result<std::unique_ptr<StepEngine>> make_tait_engine(const opencl::Device& device,
                                                     DeviceArithmetic arithmetic) {
  std::string options = "-cl-std=CL1.2";
  if (arithmetic == DeviceArithmetic::exact) {
    if (!device.is_exact) {
      return Error{"not_available", "/device",
                   device.name + " has no exact arithmetic; use the arithmetic fast"};
    }
    options += " -DVAT_EXACT -cl-fp32-correctly-rounded-divide-sqrt";
  }
  Result<std::unique_ptr<Program>> program = Program::create(device, kTaitKernels, options);
  if (!program) return program.errors();
  return std::unique_ptr<StepEngine>(new TaitEngine(std::move(program).value(), arithmetic));
}

}  // namespace vat
