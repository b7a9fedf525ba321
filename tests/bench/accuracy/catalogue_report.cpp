#include "tests/bench/accuracy/catalogue_report.h"

#include <algorithm>
#include <utility>

#include "core/support/check.h"
#include "tests/bench/accuracy/problem.h"
#include "tests/bench/report/quantile.h"

namespace vat::bench {

using validation::Run;

namespace {

std::vector<std::string> scene_names() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(VAT_DEFAULT_SCENES_DIR)) {
    if (entry.path().extension() == ".json") names.push_back(entry.path().stem().string());
  }
  std::ranges::sort(names);
  return names;
}

std::string solver_of(const Scene& scene) {
  const bool has_liquid = std::ranges::any_of(
      scene.bodies, [](const BodyDescription& body) { return body.kind == BodyKind::liquid; });
  return has_liquid ? to_string(scene.pressure_solver) : "";
}

Scene refine(Scene scene, std::uint32_t factor) {
  scene.numerics.step /= factor;
  scene.incompressible.density_tolerance = 1e-5;
  scene.incompressible.divergence_tolerance = 1e-5;
  return scene;
}

/// The centres of mass at the start, at kEarly and at the later time.
struct Paths {
  std::vector<Vec3> start, early, late;
};

Paths follow(const Scene& scene, Real late, TaskRunner* runner) {
  Run run(scene, runner);
  Paths paths{centers_of(run), {}, {}};
  run.advance_to(kEarly);
  paths.early = centers_of(run);
  run.advance_to(late);
  paths.late = centers_of(run);
  return paths;
}

double median_speed(const Scene& scene, const CatalogueSettings& settings, TaskRunner* runner) {
  std::vector<double> speeds;
  for (int n = 0; n < settings.repetitions; ++n) {
    Run run(scene, runner);
    run.advance_to(settings.timed);
    speeds.push_back(settings.timed / run.seconds());
  }
  return median(std::move(speeds));
}

CatalogueResult measure(const std::string& name, const CatalogueSettings& settings,
                        TaskRunner* runner) {
  const Scene scene = load_catalogue(name);
  CatalogueResult result{.scene = name,
                         .pressure_solver = solver_of(scene),
                         .particles = Run(scene, runner).simulation().particle_count(),
                         .step = scene.numerics.step};
  const Paths paths = follow(scene, settings.late, runner);
  const Paths exact = follow(refine(scene, settings.refined), settings.late, runner);
  result.early_error = distance(paths.early, exact.early) / distance(exact.start, exact.early);
  result.late_error = distance(paths.late, exact.late) / distance(exact.start, exact.late);
  result.speed = median_speed(scene, settings, runner);
  return result;
}

}  // namespace

std::vector<CatalogueResult> measure_catalogue(const CatalogueSettings& settings,
                                               TaskRunner* runner) {
  VAT_CHECK(settings.late > kEarly && settings.repetitions > 0 && settings.refined > 1);
  std::vector<CatalogueResult> results;
  for (const std::string& name : scene_names()) {
    results.push_back(measure(name, settings, runner));
  }
  return results;
}

Table catalogue_table(const std::vector<CatalogueResult>& results) {
  Table table{{"scene", "pressure solver", "particles", "step [ms]", "error at 0.3 s",
               "error later", "times real time"},
              {}};
  for (const CatalogueResult& result : results) {
    table.rows.push_back({result.scene, result.pressure_solver, std::uint64_t{result.particles},
                          1e3 * result.step, result.early_error, result.late_error, result.speed});
  }
  return table;
}

Status write_catalogue(const std::vector<CatalogueResult>& results,
                       const std::filesystem::path& folder) {
  return write_table(catalogue_table(results), folder, "catalogue",
                     "# Error and time of the scenes of the catalogue");
}

}  // namespace vat::bench
