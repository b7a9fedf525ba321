#include "server/output/diagnostics_writer.h"

#include <initializer_list>
#include <utility>

#include "protocol/files/text.h"

namespace vat {

namespace {

void append_names(std::string& row, const std::string& body,
                  std::initializer_list<const char*> quantities) {
  for (const char* quantity : quantities) {
    row += ',';
    append_csv_field(row, body + '.' + quantity);
  }
}

std::string header_row(const Diagnostics& diagnostics) {
  std::string row =
      "time,kinetic_energy,gravitational_energy,elastic_energy,contact_energy,"
      "mean_density_error,max_density_error,torn_springs,particles_outside,emitted_particles,"
      "drained_particles,guard_events";
  if (diagnostics.volume) {
    row +=
        ",velocity_iterations,mean_velocity_residual,max_velocity_residual,"
        "place_iterations,mean_place_residual,max_place_residual";
  }
  for (const BodyDiagnostics& body : diagnostics.bodies) {
    append_names(row, body.name,
                 {"mass", "x", "y", "z", "px", "py", "pz", "lx", "ly", "lz", "fx", "fy", "fz", "tx",
                  "ty", "tz"});
    if (body.orientation) append_names(row, body.name, {"qw", "qx", "qy", "qz"});
    if (body.angular_velocity) append_names(row, body.name, {"wx", "wy", "wz"});
  }
  return row + '\n';
}

void append_values(std::string& row, std::initializer_list<Real> values) {
  for (const Real value : values) {
    row += ',';
    append_number(row, value);
  }
}

void append_axes(std::string& row, const Vec3& v) {
  append_values(row, {v.x(), v.y(), v.z()});
}

void append_body(std::string& row, const BodyDiagnostics& body) {
  append_values(row, {body.mass});
  append_axes(row, body.center_of_mass);
  append_axes(row, body.linear_momentum);
  append_axes(row, body.angular_momentum);
  append_axes(row, body.outer_force);
  append_axes(row, body.outer_torque);
  if (body.orientation) {
    const Quat& q = *body.orientation;
    append_values(row, {q.w(), q.x(), q.y(), q.z()});
  }
  if (body.angular_velocity) append_axes(row, *body.angular_velocity);
}

std::string value_row(const Diagnostics& d, std::uint64_t guard_events) {
  std::string row;
  append_number(row, d.time);
  append_values(row, {d.kinetic_energy, d.gravitational_energy, d.elastic_energy, d.contact_energy,
                      d.mean_density_error, d.max_density_error});
  row += ',' + std::to_string(d.torn_springs) + ',' + std::to_string(d.particles_outside) + ',' +
         std::to_string(d.emitted_particles) + ',' + std::to_string(d.drained_particles) + ',' +
         std::to_string(guard_events);
  if (d.volume) {
    for (const SolveReport& solve : {d.volume->velocities, d.volume->places}) {
      append_values(row, {static_cast<Real>(solve.iterations), solve.mean, solve.greatest});
    }
  }
  for (const BodyDiagnostics& body : d.bodies) append_body(row, body);
  return row + '\n';
}

}  // namespace

DiagnosticsWriter::DiagnosticsWriter(OutputFile file) : file_(std::move(file)) {}

Result<DiagnosticsWriter> DiagnosticsWriter::create(const std::string& name,
                                                    const Simulation& simulation) {
  Result<OutputFile> file = OutputFile::create(name);
  if (!file) return file.errors();
  const Status written = file.value().append(header_row(simulation.diagnostics()));
  if (!written) return written.errors();
  return DiagnosticsWriter(std::move(file).value());
}

Status DiagnosticsWriter::write(const Simulation& simulation, std::uint64_t guard_events) {
  return file_.append(value_row(simulation.diagnostics(), guard_events));
}

Status DiagnosticsWriter::finish() {
  return file_.commit();
}

}  // namespace vat
