#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>

#include "core/simulation/simulation.h"
#include "core/threads/thread_pool.h"
#include "protocol/python/native/convert.h"

namespace vat::python {

/// Simulation of a Python object. Any thread may call it; calls wait for each other, and do not
/// hold the interpreter's lock while they wait or compute. The arrays of particles are views. A
/// change of the simulation while views exist moves the simulation to other memory, so that the
/// views keep their values.
class HeldSimulation {
 public:
  /// Throws InputError for an invalid scene.
  HeldSimulation(const Scene& scene, std::size_t threads, const std::string& instructions);
  /// Throws InputError for bytes that Simulation::load() rejects.
  HeldSimulation(std::span<const std::uint8_t> bytes, std::size_t threads);

  /// Exclusive use of the simulation while the object exists. The thread holds the interpreter's
  /// lock, except while the constructor waits.
  class Turn {
   public:
    explicit Turn(HeldSimulation& held);
    const Simulation& get() const { return *held_.content_->simulation; }
    const Simulation* operator->() const { return &get(); }
    /// Returns the simulation for a change. Views keep their values.
    Simulation& change();
    /// Returns a read-only array of `count` rows of three numbers or, without `rows`, of `count`
    /// numbers. The array keeps its memory alive.
    template <class Number>
    pybind11::array view(const Number* data, std::size_t count, bool rows) const;

   private:
    HeldSimulation& held_;
    std::unique_lock<std::mutex> lock_;
  };

 private:
  struct Content {
    std::optional<ThreadPoolRunner> runner;
    std::optional<Simulation> simulation;
  };
  /// Owner of the memory of views: the simulation and, after a change, the kept memory.
  struct Views {
    std::shared_ptr<Content> content;
    std::shared_ptr<const void> kept;
  };

  TaskRunner* start_runner(std::size_t threads);

  std::mutex mutex_;
  std::shared_ptr<Content> content_;
  std::shared_ptr<Views> views_;
};

template <class Number>
pybind11::array HeldSimulation::Turn::view(const Number* data, std::size_t count, bool rows) const {
  using Owner = std::shared_ptr<Views>;
  auto owner = std::make_unique<Owner>(held_.views_);
  pybind11::capsule base(owner.get(), [](void* pointer) { delete static_cast<Owner*>(pointer); });
  static_cast<void>(owner.release());
  return read_only_array(data, count, rows, base);
}

}  // namespace vat::python
