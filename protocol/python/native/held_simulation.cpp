#include "protocol/python/native/held_simulation.h"

#include <utility>

namespace vat::python {

TaskRunner* HeldSimulation::start_runner(std::size_t threads) {
  content_ = std::make_shared<Content>();
  views_ = std::make_shared<Views>(Views{content_, nullptr});
  return threads > 1 ? &content_->runner.emplace(threads) : nullptr;
}

HeldSimulation::HeldSimulation(const Scene& scene, std::size_t threads,
                               const std::string& instructions) {
  const InstructionSet set =
      instructions.empty() ? best_instruction_set() : value_of(parse_instruction_set(instructions));
  TaskRunner* runner = start_runner(threads);
  std::optional<Result<Simulation>> created;
  {
    const pybind11::gil_scoped_release released;
    created.emplace(Simulation::create(scene, runner, set));
  }
  content_->simulation.emplace(value_of(std::move(*created)));
}

HeldSimulation::HeldSimulation(std::span<const std::uint8_t> bytes, std::size_t threads) {
  TaskRunner* runner = start_runner(threads);
  content_->simulation.emplace(value_of(Simulation::load(bytes, runner)));
}

HeldSimulation::Turn::Turn(HeldSimulation& held)
    : held_(held), lock_(held.mutex_, std::defer_lock) {
  // A thread with the interpreter's lock must not wait for a thread that needs it.
  const pybind11::gil_scoped_release released;
  lock_.lock();
}

Simulation& HeldSimulation::Turn::change() {
  Simulation& simulation = *held_.content_->simulation;
  if (held_.views_.use_count() > 1) {
    held_.views_->kept = simulation.keep_views();
    held_.views_->content.reset();
    held_.views_ = std::make_shared<Views>(Views{held_.content_, nullptr});
  }
  return simulation;
}

}  // namespace vat::python
