#include "server/output/frame_formats.h"

#include <array>
#include <cstdint>

#include "server/output/bytes.h"
#include "server/output/series_writer.h"

namespace vat {

namespace {

using Colour = std::array<std::uint8_t, 3>;

Colour colour_of(BodyKind kind) {
  switch (kind) {
    case BodyKind::liquid:
      return {64, 128, 255};
    case BodyKind::deformable:
      return {80, 200, 100};
    case BodyKind::rigid:
      return {230, 140, 50};
  }
  VAT_CHECK(false);
}

std::string ply_header(const Simulation& simulation) {
  return "ply\nformat binary_little_endian 1.0\ncomment vat, time " +
         std::to_string(simulation.time()) + " s\nelement vertex " +
         std::to_string(simulation.particle_count()) +
         "\nproperty float x\nproperty float y\nproperty float z"
         "\nproperty float vx\nproperty float vy\nproperty float vz\nproperty float radius"
         "\nproperty uchar red\nproperty uchar green\nproperty uchar blue"
         "\nproperty uint body\nend_header\n";
}

void append_body(std::string& bytes, const BodyView& body, std::uint32_t number) {
  const Colour colour = colour_of(body.kind);
  const auto append_real = [&](Real value) { append_bytes(bytes, static_cast<float>(value)); };
  for (std::size_t i = 0; i < body.positions.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) append_real(body.positions[i][axis]);
    for (int axis = 0; axis < 3; ++axis) append_real(body.velocities[i][axis]);
    append_real(body.radii[i]);
    for (const std::uint8_t part : colour) append_bytes(bytes, part);
    append_bytes(bytes, number);
  }
}

// Single precision: PLY is for viewing, and not every viewer reads doubles.
class PlyWriter final : public SeriesWriter {
 public:
  using SeriesWriter::SeriesWriter;

 protected:
  Status write_content(const Simulation& simulation, OutputFile& file) override {
    bytes_ = ply_header(simulation);
    std::uint32_t number = 0;
    for (const BodyView& body : simulation.bodies()) append_body(bytes_, body, number++);
    return file.append(bytes_);
  }

 private:
  std::string bytes_;
};

}  // namespace

Result<std::unique_ptr<FrameWriter>> create_ply_writer(const std::string& name,
                                                       std::size_t frame_count) {
  return std::unique_ptr<FrameWriter>(std::make_unique<PlyWriter>(name, frame_count));
}

}  // namespace vat
