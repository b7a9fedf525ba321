#include <cmath>
#include <numbers>
#include <optional>

#include "tests/validation/cases.h"
#include "tests/validation/cases/liquid/liquid_rest.h"
#include "tests/validation/cases/liquid/liquid_wave.h"
#include "tests/validation/reference.h"

namespace vat::validation {

namespace {

/// Returns the x coordinate of the liquid's centre of mass in the tank [m].
Real center(const Run& run) {
  return run.diagnostics().bodies[0].center_of_mass.x() - run.simulation().vat_offset().x();
}

/// Returns the height of a gas layer with the uncompressed height z, under the weight above it.
Real pressed_gas(Real z, Real depth, Real c2) {
  return -c2 / kGravity * std::log(1 - kGravity * z / (c2 + kGravity * depth));
}

/// Moves every particle of a lattice to its height under the weight above it.
void press_together(ParticleShape& shape, Real depth, const Scene& scene) {
  const Real c2 = scene.materials[0].liquid->stiffness;
  const bool tait = scene.pressure_solver == PressureSolver::tait;
  for (Vec3& x : shape.positions) {
    x.z() = tait ? pressed_height(x.z(), depth - x.z(), c2) : pressed_gas(x.z(), depth, c2);
  }
}

/// Returns the lattice particles of the scene's first body.
ParticleShape lattice_of(const Scene& scene) {
  const Run run(scene);
  const std::span<const Vec3> places = run.body().positions;
  ParticleShape shape;
  shape.positions.assign(places.begin(), places.end());
  return shape;
}

// LIQ-12.

constexpr Real kWave = 0.05;  // initial amplitude of the surface [m]

/// Particles of the solver gas move chaotically: the periods of runs whose starts differ by
/// rounding have a standard deviation of 1.5 % with 30 layers. The mean over these starts has half
/// of it.
constexpr int kStarts = 4;

/// Moves each particle by at most a millionth of the spacing, in another direction for each start.
void shift_start(ParticleShape& shape, Real spacing, int start) {
  for (std::size_t i = 0; i < shape.positions.size(); ++i) {
    const Real angle = static_cast<Real>(start) * static_cast<Real>(i);
    shape.positions[i] +=
        1e-6 * spacing * start * Vec3(std::cos(angle), 0, std::sin(angle)) / kStarts;
  }
}

Scene standing_wave(const std::string& name, int layers, int start) {
  Scene scene = load_scene(name);
  const Real depth = reference("/liquid/LIQ-12/H");
  set_spacing(scene, depth / layers);
  if (scene.pressure_solver == PressureSolver::gas) {
    set_walls_like_liquid(scene);
    scene.materials[0].liquid->viscosity = 1000 * artificial_viscosity(scene, 0.05);
  }
  ParticleShape shape = lattice_of(scene);
  press_together(shape, depth, scene);
  for (Vec3& x : shape.positions) {  // displacement of a linear wave
    const Real scale = kWave / std::sinh(std::numbers::pi * depth);
    x += scale * Vec3(-std::cosh(std::numbers::pi * x.z()) * std::sin(std::numbers::pi * x.x()), 0,
                      std::sinh(std::numbers::pi * x.z()) * std::cos(std::numbers::pi * x.x()));
  }
  shift_start(shape, depth / layers, start);
  scene.bodies[0].shape = shape;
  return with_step(scene, acoustic_step(scene, 0.01));
}

void check_standing_wave(Sheet& sheet, const std::string& name, int layers) {
  const std::string at = "/liquid/LIQ-12/modes/1/";
  const std::string of = ", " + std::to_string(layers) + " layers";
  const bool tait = name == "LIQ-12-tait";
  const bool is_judged = tait || layers > 20;
  const int starts = tait || !is_judged ? 1 : kStarts;
  const Real steepness = reference(at + "k") * kWave;
  const Real period = reference(at + "T") / (1 - 0.194641 * steepness * steepness / 2);
  Real measured = 0;
  Real decay = 0;
  std::optional<Run> last_run;
  for (int start = 0; start < starts; ++start) {
    Run& run = last_run.emplace(sheet.start(standing_wave(name, layers, start)));
    const Swing seen = observe_swing(run, 3.2, [&] { return center(run) - 0.5; });
    // Uses whole periods, since the rest position may be slightly off-centre.
    measured += (seen.zeros.at(4) - seen.zeros[0]) / 2 / starts;
    const Real first = seen.extremes[1] + seen.extremes[2];
    const Real last = seen.extremes[3] + seen.extremes[4];
    decay += std::log(first / last) / period / starts;
  }
  sheet.add("period [s]" + of, period, measured,
            tait        ? within_relative(0.01, "error of the best explicit solvers")
            : is_judged ? within_relative(0.02, "published target")
                        : reported("the layer at each wall is denser than the others"),
            *last_run);
  sheet.add(
      "viscosity from the decay [m2/s]" + of,
      reference(std::string("/measured_yardsticks/standing_wave/") +
                (tait ? "wcsph" : "mcg03 corrected") + " N~1H=20/nu_eff"),
      decay / reference(at + "deep_decay_amp_rate_per_nu"),
      reported(
          "published result of the same method; its numerical viscosity exceeds the set viscosity"),
      *last_run);
}

void run_standing_wave(Sheet& sheet, const std::string& name) {
  check_standing_wave(sheet, name, 20);
  if (sheet.quick() && name == "LIQ-12-tait") return;
  check_standing_wave(sheet, name, sheet.quick() ? 30 : 40);
}

// LIQ-13.

/// Returns the displacement of the centre of mass by linear waves, at time t after the tank started
/// to accelerate by 1 m/s^2.
Real sloshed(Real t, Real depth) {
  Real shift = 0;
  for (int n = 1; n < 200; n += 2) {
    const Real k = n * std::numbers::pi;
    const Real omega = std::sqrt(kGravity * k * std::tanh(k * depth));
    const Real surface = 4 / (kGravity * k * k) * (1 - std::cos(omega * t));
    shift += surface * 2 / (k * k * depth);
  }
  return shift;
}

void run_sliding_tank(Sheet& sheet) {
  const Real depth = reference("/liquid/LIQ-13/H");
  Scene scene = load_scene("LIQ-13");
  set_rest_mass(scene);
  set_walls_like_liquid(scene);
  scene.materials[0].liquid->viscosity = 1000 * artificial_viscosity(scene, 0.05);
  const Real spacing = scene.bodies[0].spacing;
  ParticleShape shape = lattice_of(scene);
  press_together(shape, depth, scene);
  scene.bodies[0].shape = shape;
  Run run = sheet.start(with_step(scene, acoustic_step(scene, 0.01)));
  // Effect of a rise of the surface at the wall by one spacing, in the first mode.
  const Tolerance tolerance = within(2 * spacing / (std::numbers::pi * std::numbers::pi * depth),
                                     "a surface known to a spacing at the wall");
  for (const char* time : {"0.2", "0.4", "0.6", "0.8", "1.0"}) {
    run.advance_to(std::stod(time));
    sheet.add(std::string("shift of the centre of mass at ") + time + " s [m]",
              sloshed(std::stod(time), depth), center(run) - 0.5, tolerance, run);
  }
  Real sum = 0;
  int samples = 0;
  run.observe_until(sheet.quick() ? 2.3 : 3.6, 0.02, [&] {
    sum += center(run) - 0.5;
    ++samples;
  });
  sheet.add("mean shift of the centre of mass from 1 s on [m]",
            reference("/liquid/LIQ-13/steady_slope") / (12 * depth), sum / samples, tolerance, run);
}

}  // namespace

std::vector<Case> liquid_tank_cases() {
  return {{"LIQ-12",
           "standing wave",
           "liquid",
           {"LIQ-12"},
           [](Sheet& sheet) { run_standing_wave(sheet, "LIQ-12"); }},
          {"LIQ-12-tait",
           "standing wave of weakly compressible liquid",
           "liquid",
           {"LIQ-12-tait"},
           [](Sheet& sheet) { run_standing_wave(sheet, "LIQ-12-tait"); }},
          {"LIQ-13", "sliding tank", "liquid", {"LIQ-13"}, run_sliding_tank}};
}

}  // namespace vat::validation
