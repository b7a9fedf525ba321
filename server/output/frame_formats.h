#pragma once

#include "server/output/frame_writer.h"

/// Writers for the file formats of create_frame_writer().
///
/// A series has one file per output time. `frame_count` is the number of output times and
/// determines the file names, see series_name(). write() creates each file and returns its errors.
/// The creation of the writer does not fail.
namespace vat {

/// Returns a writer of a table. Columns: time [s], body, kind, particle (index in the body), x, y,
/// z [m], vx, vy, vz [m/s], density [kg/m^3], pressure [Pa]. Density and pressure are empty except
/// for liquids. Creates the file, and returns an error if the creation fails.
Result<std::unique_ptr<FrameWriter>> create_csv_writer(const std::string& name);

/// Returns a writer of an array [times, particles, 6] of float64: x, y, z [m], vx, vy, vz [m/s].
/// The number of particles must be constant. Creates the file, and returns an error if the creation
/// fails.
Result<std::unique_ptr<FrameWriter>> create_npy_writer(const std::string& name);

/// Returns a writer of a ZIP archive of arrays for numpy.load(). T is the number of output times, P
/// the greatest number of particles that the scene can have:
///
/// - `time` [T] float64 [s], `count` [T] int64: number of particles;
/// - `body` [T, P] int32: index of the body in the scene; `number` [T, P] int32: number of the
///   particle in its body, which does not change while other particles appear or disappear;
/// - `position` [T, P, 3] [m] and `velocity` [T, P, 3] [m/s], float64.
///
/// Elements from `count` on are -1 or NaN. In the file of a failed run, the times after the last
/// output have the count 0. Creates the file, and returns an error if the creation fails.
Result<std::unique_ptr<FrameWriter>> create_npz_writer(const std::string& name,
                                                       std::size_t frame_count);

/// Returns a writer of one binary glTF file, in single precision. Rigid bodies are meshes whose
/// translation and rotation are animated. The particles of liquids and deformable bodies are points
/// with one mesh for each of at most 120 key frames, and at most 20 million points in all. With
/// liquid surfaces, the key frames contain the surface of each liquid material instead of its
/// particles. Colours are those of the materials. The writer keeps the content in memory until
/// finish(). Creates the file, and returns an error if the creation fails.
Result<std::unique_ptr<FrameWriter>> create_glb_writer(const std::string& name,
                                                       const FrameContent& content);

/// Returns a writer of an Alembic archive (Ogawa) in single precision, below an object that turns
/// the z axis upwards. Particles of liquids and deformable bodies are points with velocities, ids
/// (numbers in the body) and one width. Rigid bodies are transformations with a mesh. With liquid
/// surfaces, each liquid material also has a mesh that changes with time. Creates the file, and
/// returns an error if the creation fails.
Result<std::unique_ptr<FrameWriter>> create_abc_writer(const std::string& name,
                                                       bool has_liquid_surfaces);

/// Returns a writer of a series of binary point files for viewers. Properties in single precision:
/// position [m], velocity [m/s], radius [m], colour by kind of body, index of the body in the
/// scene.
Result<std::unique_ptr<FrameWriter>> create_ply_writer(const std::string& name,
                                                       std::size_t frame_count);

/// Returns a writer of a series of VTK files (.vtu, binary, compressed by LZ4) and of a list of
/// them with their times (.pvd). Each particle has these properties: position [m], velocity [m/s],
/// index of the body in the scene, kind of the body (number of BodyKind), radius [m], density
/// [kg/m^3] and pressure [Pa]. If the body is not a liquid, density and pressure are 0. The
/// function creates the list, and returns an error if the creation fails.
Result<std::unique_ptr<FrameWriter>> create_pvd_writer(const std::string& name,
                                                       std::size_t frame_count);

}  // namespace vat
