#include <cmath>
#include <numbers>

#include "tests/validation/cases.h"
#include "tests/validation/cases/liquid/liquid_rest.h"
#include "tests/validation/reference.h"

namespace vat::validation {

namespace {

/// Returns the speed of the vortices at x, relative to the maximum.
Real pattern(const Vec3& x) {
  const Vec3 angle = 2 * std::numbers::pi * x;
  return std::hypot(std::cos(angle.x()) * std::sin(angle.z()),
                    std::sin(angle.x()) * std::cos(angle.z()));
}

/// Returns the mean difference between the particles' speeds and the solution, relative to the mean
/// speed of the solution.
Real speed_error(const Run& run, Real greatest) {
  const BodyView body = run.body();
  Real error = 0;
  Real scale = 0;
  for (std::size_t i = 0; i < body.positions.size(); ++i) {
    const Real exact = greatest * pattern(body.positions[i]);
    error += std::abs(body.velocities[i].norm() - exact);
    scale += exact;
  }
  return error / scale;
}

void run_vortices(Sheet& sheet) {
  const std::string published =
      "/measured_yardsticks/taylor_green_Re100/mcg03 corrected, p clamped N=50/t=";
  const std::string source = "same method elsewhere, 50 x 50";
  Scene scene = load_scene("LIQ-6");
  set_rest_mass(scene);
  Run run = sheet.start(with_step(scene, acoustic_step(scene, 0.01)));
  const Real energy = run.diagnostics().kinetic_energy;
  for (const char* time : {"0.1", "0.2", "0.5", "2"}) {
    const bool late = time == std::string("2");
    if (sheet.quick() && late) continue;
    run.advance_to(std::stod(time));
    const std::string at = std::string(", t = ") + time;
    const Real greatest = reference(std::string("/liquid/LIQ-6/umax/") + time);
    const Real exact = reference(std::string("/liquid/LIQ-6/Ek_ratio/") + time);
    const Real error = speed_error(run, greatest);
    const Real ratio = run.diagnostics().kinetic_energy / energy / exact;
    if (late) {
      const std::string cause =
          "published result of the same method; without negative pressure, mixing is poor";
      sheet.add("L1 error of the speeds" + at, reference(published + "2/L1"), error,
                reported(cause), run);
      sheet.add("kinetic energy / exact kinetic energy" + at, reference(published + "2/Ek"), ratio,
                reported(cause), run);
      continue;
    }
    sheet.add("L1 error of the speeds" + at, 0, error,
              within(reference(published + "0.5/L1"), source), run);
    sheet.add("kinetic energy / exact kinetic energy" + at, 1, ratio,
              within(1 - reference(published + "0.5/Ek"), source), run);
  }
}

void run_tait_vortices(Sheet& sheet) {
  const std::string published = "/measured_yardsticks/taylor_green_Re100/tvf N=50/";
  Scene scene = load_scene("LIQ-6-tait");
  Run run = sheet.start(with_step(scene, acoustic_step(scene, 0.01)));
  const Real energy = run.diagnostics().kinetic_energy;
  for (const char* time : {"0.5", "2"}) {
    const bool late = time == std::string("2");
    if (sheet.quick() && late) continue;
    run.advance_to(std::stod(time));
    const std::string at = std::string(", t = ") + time;
    const Real greatest = reference(std::string("/liquid/LIQ-6/umax/") + time);
    const Real exact = reference(std::string("/liquid/LIQ-6/Ek_ratio/") + time);
    sheet.add("L1 error of the speeds" + at, late ? reference(published + "t=2/L1") : 0.03,
              speed_error(run, greatest), at_most("particle shifting elsewhere, 50 x 50"), run);
    // The published maximum speed exceeds the solution by this amount.
    const Real excess = reference(published + "t=" + time + "/umax") - 1;
    sheet.add("kinetic energy / exact kinetic energy" + at, 1,
              run.diagnostics().kinetic_energy / energy / exact,
              within(2 * excess, "the speeds of particle shifting elsewhere, squared"), run);
  }
}

}  // namespace

std::vector<Case> liquid_vortex_cases() {
  return {{"LIQ-6", "Taylor-Green vortices", "liquid", {"LIQ-6"}, run_vortices},
          {"LIQ-6-tait",
           "Taylor-Green vortices of weakly compressible liquid",
           "liquid",
           {"LIQ-6-tait"},
           run_tait_vortices}};
}

}  // namespace vat::validation
