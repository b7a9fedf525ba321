#pragma once

#include "server/output/frame_writer.h"

namespace vat {

/// Legacy VTK polydata in text: position [m] and velocity [m/s] of each particle, the body's place
/// in the scene, its kind (the number of BodyKind), radius [m], density [kg/m^3] and pressure [Pa];
/// the last two are 0 except for liquids.
///
/// `frame_count` is the number of times that will be written: it decides on the names of the files,
/// see series_name(). Each file is created by its write(), which gives the errors; creating the
/// writer does not fail.
Result<std::unique_ptr<FrameWriter>> create_vtk_writer(const std::string& name,
                                                       std::size_t frame_count);

}  // namespace vat
