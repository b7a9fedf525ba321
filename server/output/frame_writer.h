#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "core/simulation/simulation.h"
#include "core/support/result.h"

namespace vat {

/// Writer of the particles of a simulation at a series of times. Particles are in the order of the
/// scene's bodies. The path of every error is the file name.
class FrameWriter {
 public:
  virtual ~FrameWriter() = default;
  /// Writes the current state as one output time.
  virtual Status write(const Simulation& simulation) = 0;
  /// Completes the output. Without this call, a file with all output times has the extension
  /// ".part".
  virtual Status finish() = 0;
};

/// Content of an output.
struct FrameContent {
  std::size_t frame_count = 1;       ///< number of output times
  bool has_liquid_surfaces = false;  ///< only for formats with surfaces, see can_have_surfaces()
};

/// File name extensions that create_frame_writer() supports, for error messages.
inline constexpr const char* kFrameEndings = ".csv, .pvd, .ply, .npy, .npz, .glb or .abc";

/// Returns whether the name has one of the extensions in kFrameEndings.
bool is_frame_file_name(const std::string& name);

/// Returns whether the format of the name's extension can contain the surfaces of liquids.
bool can_have_surfaces(const std::string& name);

/// Returns a writer for the file name's extension, which must be known:
/// - `.csv`: one row per particle and time, with a header row.
/// - `.pvd`: a list of VTK files, one `.vtu` file per time (see series_name()).
/// - `.ply`: binary points coloured by kind of body, one file per time.
/// - `.npy`: one array [times, particles, 6] of float64: x, y, z, vx, vy, vz.
/// - `.npz`: arrays by name; the number of particles may change.
/// - `.glb`: glTF with animation, for viewers of pictures.
/// - `.abc`: Alembic, for programs of animation.
Result<std::unique_ptr<FrameWriter>> create_frame_writer(const std::string& name,
                                                         const FrameContent& content);

/// Returns the name of one file of a series: "run-0000.ply" for "run.ply" and index 0. A series of
/// one file uses `name`.
std::string series_name(const std::string& name, std::size_t index, std::size_t count);

}  // namespace vat
