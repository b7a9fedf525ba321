#include "tests/validation/run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "core/device/device_use.h"
#include "protocol/scene/scene_json.h"

namespace vat::validation {

namespace {

std::string run_text_of(const Errors& errors) {
  std::string text;
  for (const Error& error : errors) {
    text += (text.empty() ? "" : "; ") + error.path + ": " + error.message;
  }
  return text;
}

template <class T>
T value_of(Result<T> result, const std::string& what) {
  if (!result) throw std::invalid_argument(what + ": " + run_text_of(result.errors()));
  return std::move(result).value();
}

/// Returns the number of steps in an interval. Throws if it is not whole.
std::uint32_t whole_steps(Real interval, Real step) {
  const Real count = std::round(interval / step);
  if (count < 0 || std::abs(interval / step - count) > 1e-6) {
    throw std::runtime_error(std::to_string(interval) + " s is not a whole number of steps of " +
                             std::to_string(step) + " s");
  }
  return static_cast<std::uint32_t>(count);
}

}  // namespace

Scene load_scene(const std::string& name) {
  return value_of(read_scene_file(VAT_SOURCE_DIR "/tests/validation/scenes/" + name + ".json"),
                  name);
}

BodyDescription& body_of(Scene& scene, std::string_view name) {
  const auto found = std::ranges::find(scene.bodies, name, &BodyDescription::name);
  if (found == scene.bodies.end()) throw std::out_of_range("no body " + std::string(name));
  return *found;
}

Scene with_method(Scene scene, IntegratorId integrator, Real step) {
  scene.numerics.integrator = integrator;
  return with_step(std::move(scene), step);
}

Scene with_step(Scene scene, Real step) {
  scene.numerics.step = step;
  scene.numerics.tick = step;
  return scene;
}

void DeviceUse::count(std::uint32_t taken, const AdvanceReport& report) {
  steps += report.device_steps;
  if (!refusal.empty() || report.device_steps == taken) return;
  refusal = "the CPU took " + std::to_string(taken - report.device_steps) + " of " +
            std::to_string(taken) + " steps";
}

Run::Run(const Scene& scene, TaskRunner* runner, std::shared_ptr<DeviceUse> device)
    : simulation_(value_of(Simulation::create(scene, runner), scene.name)),
      device_(std::move(device)) {
  if (!device_) return;
  const Status used = use_device(device_->device, simulation_);
  if (used) return;
  const Error& first = used.errors().front();
  if (first.code != "not_on_device") throw std::invalid_argument(run_text_of(used.errors()));
  if (device_->refusal.empty()) device_->refusal = first.path;
}

void Run::advance_to(Real time) {
  const std::uint32_t count = whole_steps(time - simulation_.time(), simulation_.step_size());
  const auto begin = std::chrono::steady_clock::now();
  const AdvanceReport report = simulation_.advance(count);
  seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  steps_ += report.steps;
  force_evaluations_ += report.force_evaluations;
  particle_evaluations_ += report.particle_evaluations;
  if (device_) device_->count(count, report);
  if (report.undone_steps == 0) return;
  throw std::runtime_error("the guard undid a step (" +
                           std::string(to_string(report.events.front().cause)) +
                           ") at t = " + std::to_string(report.events.front().time) + " s");
}

void Run::observe_until(Real time, Real interval, const std::function<void()>& observe) {
  const Real begin = simulation_.time();
  observe();
  for (long i = 1; begin + interval * static_cast<Real>(i) <= time + 1e-6 * interval; ++i) {
    advance_to(begin + interval * static_cast<Real>(i));
    observe();
  }
}

BodyView Run::body(std::string_view name) const {
  const std::optional<BodyId> id = simulation_.find_body(name);
  if (!id) throw std::out_of_range("no body " + std::string(name));
  return *simulation_.find_body(*id);
}

BodyView Run::body() const {
  return simulation_.bodies().at(0);
}

Real Run::energy() const {
  const Diagnostics now = diagnostics();
  return now.kinetic_energy + now.gravitational_energy + now.elastic_energy + now.contact_energy;
}

}  // namespace vat::validation
