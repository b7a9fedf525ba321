#include "protocol/tune/tuning.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/validation/validate.h"
#include "protocol/tune/scene_run.h"

namespace vat::tune {
namespace {

constexpr double kMostTime = 2;            // of a candidate, relative to the finer reference
constexpr std::uint32_t kProbedShare = 3;  // 1 / share of the candidates that no part decides

/// Progress of the two reference runs.
class ReferenceProgress {
 public:
  ReferenceProgress(const TuneSettings& settings, const CandidateSet& set, const Parts& parts)
      : settings_(settings), set_(set), parts_(parts) {}

  void add(const Candidate& reference, double seconds) {
    ++done_;
    seconds_ += seconds;
    work_ += expected_work(reference) / parts_.count;
    const std::string stage =
        done_ <= parts_.count ? "reference run 1 of 2" : "reference run 2 of 2";
    settings_.show(stage, {done_, std::size_t{2} * parts_.count, remaining()});
  }

 private:
  double remaining() const {
    Real all = expected_work(set_.fine) + expected_work(set_.coarse);
    for (const Candidate& candidate : set_.candidates) all += expected_work(candidate);
    return seconds_ * (all - work_) / work_;
  }

  const TuneSettings& settings_;
  const CandidateSet& set_;
  const Parts& parts_;
  std::size_t done_ = 0;
  double seconds_ = 0;
  Real work_ = 0;
};

struct ReferenceRun {
  Motion motion;
  LeastMotion least;
  double seconds = 0;
};

Result<ReferenceRun> follow(const Scene& scene, const Candidate& reference, const Parts& parts,
                            const TuneSettings& settings, ReferenceProgress& progress) {
  const Scene tight = with_candidate(scene, reference);
  if (Errors errors = find_errors(tight); !errors.empty()) return errors;
  SceneRun run(tight, parts, settings);
  double seconds = 0;
  for (std::uint32_t part = 0; part < parts.count; ++part) {
    const std::optional<Segment> segment = run.advance(std::numeric_limits<double>::infinity());
    if (settings.stop()) {
      return Error{"interrupted", "", "interrupted before the reference runs were complete"};
    }
    if (!segment) {
      return Error{"no_reference", "/numerics",
                   "the reference run failed (" + describe(reference, true) + ")"};
    }
    progress.add(reference, segment->seconds);
    seconds += segment->seconds;
  }
  return ReferenceRun{run.motion(), run.least(), seconds};
}

}  // namespace

Parts divide(Real until, Real tick) {
  constexpr Real kMostTicks = 1e9;
  const auto ticks =
      static_cast<std::uint32_t>(std::clamp(std::round(until / tick), Real(1), kMostTicks));
  Parts parts;
  parts.ticks = std::max(1u, (ticks + kMostParts / 2) / kMostParts);
  parts.count = std::clamp((ticks + parts.ticks / 2) / parts.ticks, 1u, 2 * kMostParts);
  parts.duration = tick * parts.ticks * parts.count;
  return parts;
}

Result<Tuning> Tuning::create(const Scene& scene, const TuneSettings& settings) {
  CandidateSet set = find_candidates(scene);
  const Parts parts = divide(settings.until, scene.numerics.tick);
  ReferenceProgress progress(settings, set, parts);
  const Result<ReferenceRun> fine = follow(scene, set.fine, parts, settings, progress);
  if (!fine) return fine.errors();
  const Result<ReferenceRun> coarse = follow(scene, set.coarse, parts, settings, progress);
  if (!coarse) return coarse.errors();
  ErrorMeasure measure(fine.value().motion, coarse.value().motion, fine.value().least);
  return Tuning(scene, settings, std::move(set), std::move(measure), parts,
                kMostTime * fine.value().seconds);
}

Tuning::Tuning(const Scene& scene, TuneSettings settings, CandidateSet set, ErrorMeasure measure,
               Parts parts, double most_seconds)
    : scene_(scene),
      settings_(std::move(settings)),
      set_(std::move(set)),
      measure_(std::move(measure)),
      parts_(parts),
      most_seconds_(most_seconds) {}

SearchSettings Tuning::search_settings() const {
  SearchSettings search;
  search.candidates = set_.candidates.size();
  search.moments = parts_.count;
  // The parts of a probe do not prove that another candidate is better.
  const bool is_proven = settings_.drops == DropRule::proven;
  search.probe = is_proven ? 1u : std::max(1u, parts_.count / kProbedShare);
  search.duration = parts_.duration;
  search.repetitions = settings_.repetitions;
  search.drops = settings_.drops;
  search.most_seconds = most_seconds_;
  search.floor = measure_.floor();
  search.stop = settings_.stop;
  search.show = [this](const Progress& progress) { settings_.show("candidates", progress); };
  return search;
}

std::vector<Outcome> Tuning::search() const {
  return tune::search(search_settings(), [this](std::size_t candidate) {
    return std::make_unique<SceneTrial>(with_candidate(scene_, set_.candidates[candidate]), parts_,
                                        measure_, settings_);
  });
}

std::vector<Point> Tuning::points(const std::vector<Outcome>& outcomes) const {
  return points_of(outcomes, search_settings());
}

}  // namespace vat::tune
