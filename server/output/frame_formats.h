#pragma once

#include "server/output/frame_writer.h"

/// Writers of the formats of create_frame_writer().
///
/// A series has one file per output time. `frame_count` is the number of times that will be
/// written: it decides on the names of the files, see series_name(). Each file is created by its
/// write(), which gives the errors; creating the writer does not fail.
namespace vat {

/// A table with the columns time [s], body, kind, particle (index in the body), x, y, z [m], vx,
/// vy, vz [m/s], density [kg/m^3] and pressure [Pa]; the last two are empty except for liquids.
/// Creates the file at once, and fails if that fails.
Result<std::unique_ptr<FrameWriter>> create_csv_writer(const std::string& name);

/// An array [times, particles, 6] of float64: x, y, z [m], vx, vy, vz [m/s]. The number of
/// particles must not change. Creates the file at once, and fails if that fails.
Result<std::unique_ptr<FrameWriter>> create_npy_writer(const std::string& name);

/// A series of binary points for viewers, in single precision: position [m], velocity [m/s], radius
/// [m], colour by kind of body, and the body's place in the scene.
Result<std::unique_ptr<FrameWriter>> create_ply_writer(const std::string& name,
                                                       std::size_t frame_count);

/// A series of legacy VTK polydata in text: position [m] and velocity [m/s] of each particle, the
/// body's place in the scene, its kind (the number of BodyKind), radius [m], density [kg/m^3] and
/// pressure [Pa]; the last two are 0 except for liquids.
Result<std::unique_ptr<FrameWriter>> create_vtk_writer(const std::string& name,
                                                       std::size_t frame_count);

}  // namespace vat
