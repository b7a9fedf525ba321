#pragma once

#include <optional>

#include "protocol/tune/tuning.h"

namespace vat::tune {

/// Run of a scene in parts, with measured computing time.
class SceneRun {
 public:
  /// Creates the simulation of a valid scene. `settings` must outlive the run.
  SceneRun(const Scene& scene, const Parts& parts, const TuneSettings& settings);

  /// Runs to the next moment and measures it, or runs until the computing time of this part exceeds
  /// `most_seconds`, without a measurement. Returns nothing after a guard event, or if the run is
  /// stopped. The segment has no bound.
  std::optional<Segment> advance(double most_seconds);
  /// Keeps only a snapshot until the next call of advance().
  void suspend();

  /// Returns the measured moments, beginning with time 0.
  const Motion& motion() const { return motion_; }
  const LeastMotion& least() const { return least_; }

 private:
  Simulation& simulation();
  bool take_tick(Segment& segment);

  const TuneSettings& settings_;
  Parts parts_;
  std::vector<bool> free_bodies_;
  std::optional<Simulation> simulation_;
  std::optional<Snapshot> snapshot_;
  Motion motion_;
  LeastMotion least_;
};

/// Trial of a candidate that runs its scene.
class SceneTrial final : public Trial {
 public:
  /// `measure` and `settings` must outlive the trial.
  SceneTrial(const Scene& scene, const Parts& parts, const ErrorMeasure& measure,
             const TuneSettings& settings)
      : measure_(measure), run_(scene, parts, settings) {}

  std::optional<Segment> advance(double most_seconds) override;
  void suspend() override { run_.suspend(); }

 private:
  const ErrorMeasure& measure_;
  SceneRun run_;
};

}  // namespace vat::tune
