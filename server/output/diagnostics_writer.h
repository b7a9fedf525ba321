#pragma once

#include <cstdint>
#include <string>

#include "core/simulation/simulation.h"
#include "core/support/result.h"
#include "server/output/output_file.h"

namespace vat {

/// One CSV row per output time: time, energies, density errors, particles outside, guard events so
/// far, for an incompressible liquid the iterations and residuals of the last step's solves of its
/// velocities and places, then for each body NAME.mass, the centre of mass NAME.x y z, the linear
/// and angular momentum about the origin NAME.px py pz lx ly lz, the outer force and its torque
/// about the centre of mass NAME.fx fy fz tx ty tz (see BodyDiagnostics), and for a rigid body its
/// orientation NAME.qw qx qy qz and angular velocity NAME.wx wy wz.
class DiagnosticsWriter {
 public:
  /// Creates the file and its header row.
  static Result<DiagnosticsWriter> create(const std::string& name, const Simulation& simulation);

  Status write(const Simulation& simulation, std::uint64_t guard_events);
  /// Completes the file; without it it keeps the ending ".part".
  Status finish();

 private:
  explicit DiagnosticsWriter(OutputFile file);
  OutputFile file_;
};

}  // namespace vat
