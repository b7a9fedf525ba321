#include "server/output/frame_formats.h"

#include <utility>

#include "protocol/files/output_file.h"
#include "server/output/array_header.h"
#include "server/output/bytes.h"

namespace vat {

namespace {

std::string npy_header(std::size_t frame_count, std::size_t particle_count) {
  return array_header("<f8", {frame_count, particle_count, 6});
}

class NpyWriter final : public FrameWriter {
 public:
  explicit NpyWriter(OutputFile file) : file_(std::move(file)) {}

  // The header is rewritten with each frame, so that the file of a failed run can be read.
  Status write(const Simulation& simulation) override {
    if (frame_count_ > 0 && simulation.particle_count() != particle_count_) {
      return Error{"not_allowed", "", "an .npy file cannot hold a changing number of particles"};
    }
    particle_count_ = simulation.particle_count();
    bytes_.clear();
    for (const BodyView& body : simulation.bodies()) append_body(body);
    if (Status written = file_.append(bytes_); !written) return written;
    return file_.write_at(0, npy_header(++frame_count_, particle_count_));
  }

  Status finish() override { return file_.commit(); }

 private:
  void append_body(const BodyView& body) {
    for (std::size_t i = 0; i < body.positions.size(); ++i) {
      for (int axis = 0; axis < 3; ++axis) append_bytes(bytes_, body.positions[i][axis]);
      for (int axis = 0; axis < 3; ++axis) append_bytes(bytes_, body.velocities[i][axis]);
    }
  }

  OutputFile file_;
  std::size_t frame_count_ = 0;
  std::size_t particle_count_ = 0;
  std::string bytes_;
};

}  // namespace

Result<std::unique_ptr<FrameWriter>> create_npy_writer(const std::string& name) {
  Result<OutputFile> file = OutputFile::create(name);
  if (!file) return file.errors();
  if (Status written = file.value().append(npy_header(0, 0)); !written) return written.errors();
  return std::unique_ptr<FrameWriter>(std::make_unique<NpyWriter>(std::move(file).value()));
}

}  // namespace vat
