#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "core/sampling/nozzle.h"
#include "server/output/array_header.h"
#include "server/output/bytes.h"
#include "server/output/frame_formats.h"
#include "server/output/zip_archive.h"

namespace vat {

namespace {

// The arrays, in the order of the archive.
enum NpzArray : std::size_t { kTime, kCount, kBody, kNumber, kPosition, kVelocity };

struct NpzLayout {
  const char* name;
  const char* type;
  std::size_t components;  ///< per particle; 0 for one number per output time
  std::size_t bytes;       ///< of a number
};
constexpr NpzLayout kNpzArrays[] = {{"time", "<f8", 0, 8},     {"count", "<i8", 0, 8},
                                    {"body", "<i4", 1, 4},     {"number", "<i4", 1, 4},
                                    {"position", "<f8", 3, 8}, {"velocity", "<f8", 3, 8}};

/// Returns the greatest number of particles that the scene can have.
std::size_t greatest_count(const Simulation& simulation) {
  const Scene& scene = simulation.scene();
  const std::vector<BodyView> bodies = simulation.bodies();
  std::size_t count = simulation.particle_count();
  for (const BodyDescription& body : scene.bodies) {
    const std::size_t most = most_particles(scene, body);
    const auto found = std::ranges::find(bodies, std::string_view(body.name), &BodyView::name);
    if (found != bodies.end() && most > found->positions.size())
      count += most - found->positions.size();
  }
  return count;
}

/// All arrays have their final size from the start, because the number of outputs is known. The
/// file of a failed run thus contains all outputs so far.
class NpzWriter final : public FrameWriter {
 public:
  NpzWriter(OutputFile file, std::size_t frame_count)
      : file_(std::move(file)), frame_count_(frame_count) {}
  ~NpzWriter() override {
    // The run has already reported its error.
    if (archive_ && !is_complete_) static_cast<void>(archive_->complete());
  }

  Status write(const Simulation& simulation) override {
    if (!archive_) {
      if (Status opened = open(simulation); !opened) return opened;
    }
    for (std::string& array : arrays_) array.clear();
    append_bytes(arrays_[kTime], simulation.time());
    append_bytes(arrays_[kCount], static_cast<std::int64_t>(simulation.particle_count()));
    std::int32_t body_index = 0;
    for (const BodyView& body : simulation.bodies()) add_body(body, body_index++);
    pad();
    return append_arrays();
  }

  Status finish() override {
    is_complete_ = true;
    if (Status completed = archive_->complete(); !completed) return completed;
    return archive_->commit();
  }

 private:
  Status open(const Simulation& simulation) {
    row_ = greatest_count(simulation);
    std::vector<ZipArchive::MemberSize> members;
    for (std::size_t i = 0; i < std::size(kNpzArrays); ++i) {
      const NpzLayout& layout = kNpzArrays[i];
      std::vector<std::size_t> shape{frame_count_};
      if (layout.components > 0) shape.push_back(row_);
      if (layout.components > 1) shape.push_back(layout.components);
      arrays_[i] = array_header(layout.type, shape);
      std::size_t size = layout.bytes;
      for (const std::size_t extent : shape) size *= extent;
      members.push_back({std::string(layout.name) + ".npy", arrays_[i].size() + size});
    }
    archive_.emplace(std::move(file_), members);
    return append_arrays();
  }

  void add_body(const BodyView& body, std::int32_t index) {
    const auto append_vectors = [](std::string& array, std::span<const Vec3> vectors) {
      array.append(reinterpret_cast<const char*>(vectors.data()), vectors.size_bytes());
    };
    append_vectors(arrays_[kPosition], body.positions);
    append_vectors(arrays_[kVelocity], body.velocities);
    for (std::size_t i = 0; i < body.positions.size(); ++i) {
      append_bytes(arrays_[kBody], index);
      append_bytes(arrays_[kNumber],
                   static_cast<std::int32_t>(body.numbers.empty() ? i : body.numbers[i]));
    }
  }

  /// Fills the rows of particles that do not exist.
  void pad() {
    constexpr Real kNone = std::numeric_limits<Real>::quiet_NaN();
    while (arrays_[kBody].size() < row_ * sizeof(std::int32_t)) {
      append_bytes(arrays_[kBody], std::int32_t{-1});
      append_bytes(arrays_[kNumber], std::int32_t{-1});
      for (int axis = 0; axis < 3; ++axis) {
        append_bytes(arrays_[kPosition], kNone);
        append_bytes(arrays_[kVelocity], kNone);
      }
    }
  }

  Status append_arrays() {
    for (std::size_t i = 0; i < std::size(kNpzArrays); ++i) {
      if (Status written = archive_->append(i, arrays_[i]); !written) return written;
    }
    return {};
  }

  OutputFile file_;  ///< before the first output
  std::size_t frame_count_;
  std::optional<ZipArchive> archive_;
  std::size_t row_ = 0;  ///< particles of an output, including missing ones
  std::string arrays_[std::size(kNpzArrays)];
  bool is_complete_ = false;
};

}  // namespace

Result<std::unique_ptr<FrameWriter>> create_npz_writer(const std::string& name,
                                                       std::size_t frame_count) {
  static_assert(sizeof(Vec3) == 3 * sizeof(Real));
  Result<OutputFile> file = OutputFile::create(name);
  if (!file) return file.errors();
  return std::unique_ptr<FrameWriter>(
      std::make_unique<NpzWriter>(std::move(file).value(), frame_count));
}

}  // namespace vat
