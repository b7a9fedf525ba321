#include "protocol/tune/scene_run.h"

#include "core/support/check.h"

namespace vat::tune {

SceneRun::SceneRun(const Scene& scene, const Parts& parts, const TuneSettings& settings)
    : settings_(settings), parts_(parts), free_bodies_(find_free_bodies(scene)) {
  Result<Simulation> created = Simulation::create(scene, settings.runner);
  VAT_CHECK(created.ok());
  simulation_.emplace(std::move(created).value());
  motion_.push_back(measure(*simulation_, free_bodies_));
  least_ = least_motion(*simulation_, parts.duration);
}

Simulation& SceneRun::simulation() {
  if (!simulation_) {
    simulation_.emplace(Simulation::from(*snapshot_, settings_.runner));
    snapshot_.reset();
  }
  return *simulation_;
}

void SceneRun::suspend() {
  if (!simulation_) return;
  snapshot_.emplace(simulation_->snapshot());
  simulation_.reset();
}

bool SceneRun::take_tick(Segment& segment) {
  Simulation& running = simulation();
  const double begin = settings_.clock();
  const AdvanceReport report = running.advance(running.steps_per_tick());
  segment.seconds += settings_.clock() - begin;
  segment.steps += report.steps;
  const IterationCounts& counts = report.iterations;
  segment.iterations += counts.contacts + counts.damping + counts.springs + counts.elongation;
  return !report.failed && report.undone_steps == 0;
}

std::optional<Segment> SceneRun::advance(double most_seconds) {
  Segment segment;
  for (std::uint32_t tick = 0; tick < parts_.ticks; ++tick) {
    if (settings_.stop() || !take_tick(segment)) return {};
    if (segment.seconds > most_seconds) return segment;
  }
  motion_.push_back(measure(simulation(), free_bodies_));
  // The solver of incompressible liquids reports its last step only.
  if (const std::optional<VolumeReport> volume = simulation().diagnostics().volume) {
    const int iterations = volume->velocities.iterations + volume->places.iterations;
    segment.iterations += segment.steps * static_cast<std::uint64_t>(iterations);
  }
  return segment;
}

std::optional<Segment> SceneTrial::advance(double most_seconds) {
  std::optional<Segment> segment = run_.advance(most_seconds);
  if (segment) segment->bound = measure_.bound(run_.motion());
  return segment;
}

}  // namespace vat::tune
