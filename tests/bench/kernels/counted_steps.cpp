#include "tests/bench/kernels/counted_steps.h"

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <system_error>

#include "core/device/device_use.h"
#include "core/simulation/simulation.h"
#include "tests/bench/report/csv_file.h"
#include "tests/bench/report/run_program.h"
#include "tests/bench/report/table.h"
#include "tests/bench/speed/scenes.h"

namespace vat::bench {

namespace {

/// A nominal step of this scene has only one step, because the simulator takes a minute for it.
Scene incompressible_dam_break() {
  Scene scene = dam_break(12, PressureSolver::incompressible);
  scene.numerics.step = 0.002;
  return scene;
}

}  // namespace

const std::vector<CountedKernels>& counted_kernel_scenes() {
  static const std::vector<CountedKernels> kScenes = {
      {"liquid-tait", [] { return dam_break(17, PressureSolver::tait); }, 0.2},
      {"liquid-incompressible", incompressible_dam_break, 0.2},
      {"rigid", [] { return rigid_pile(25, InterfaceLaw::penalty); }, 0.3},
      {"deformable", [] { return deformable_pile(6); }, 0.3},
  };
  return kScenes;
}

Result<CountedSteps> count_kernels(const CountedKernels& scene,
                                   const std::filesystem::path& folder) {
  if (std::string(VAT_OCLGRIND).empty()) {
    return Error{"not_available", scene.name,
                 "needs Oclgrind; ./vat bench kernels installs it and builds its plugin"};
  }
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return Error{"system", folder.string(), error.message()};
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) return Error{"system", "/proc/self/exe", error.message()};
  const std::filesystem::path counts = folder / (scene.name + ".counts.csv");
  const std::filesystem::path steps = folder / (scene.name + ".steps.csv");
  std::filesystem::remove(counts, error);
  setenv("OCL_ICD_VENDORS", VAT_OCLGRIND, 1);
  setenv("OCLGRIND_PLUGINS", VAT_KERNEL_COUNTER, 1);
  setenv("OCLGRIND_GLOBAL_MEM_SIZE", "4000000000", 1);
  setenv("VAT_KERNEL_COUNTS", counts.c_str(), 1);
  const Status run =
      run_program({program.string(), kCountedKernelsCommand, scene.name, steps.string()}, folder,
                  scene.name + ".log", "");
  if (!run) return run.errors();
  const Result<CsvFile> steps_file = read_csv_file(steps);
  if (!steps_file) return steps_file.errors();
  CountedSteps counted;
  counted.particles = std::stoull(steps_file.value().rows.at(0).at(0));
  counted.steps = std::stoull(steps_file.value().rows.at(0).at(1));
  const Result<CsvFile> counts_file = read_csv_file(counts);
  if (!counts_file) return counts_file.errors();
  Result<std::vector<KernelCounts>> kernels =
      read_kernel_counts(counts_file.value(), counted.steps, counted.particles);
  if (!kernels) return kernels.errors();
  counted.kernels = std::move(kernels).value();
  return counted;
}

Status run_counted_kernels(const CountedKernels& scene, const std::filesystem::path& file) {
  Result<Simulation> created = Simulation::create(scene.make());
  if (!created) return created.errors();
  Simulation& simulation = created.value();
  const auto steps = static_cast<std::uint32_t>(std::lround(scene.start / simulation.step_size()));
  AdvanceReport report = simulation.advance(steps);
  if (report.failed) return describe(report.events.back(), simulation);
  // The simulator's arithmetic is not exact.
  const DeviceChoice device{.is_cpu = false, .arithmetic = DeviceArithmetic::fast};
  if (Status used = use_device(device, simulation); !used) return used.errors();
  report = simulation.advance(1);
  if (report.device_error) return *report.device_error;
  if (report.failed) return describe(report.events.back(), simulation);
  if (report.device_steps == 0) {
    return Error{"device_failed", "/device", "the CPU has taken the step"};
  }
  const Table table{{"particles", "steps"},
                    {{std::uint64_t{simulation.particle_count()}, report.steps}}};
  return write_text(file, to_csv(table));
}

}  // namespace vat::bench
