#include "server/output/frame_formats.h"

#include <utility>
#include <vector>

#include "protocol/files/output_file.h"
#include "protocol/files/text.h"

namespace vat {

namespace {

void append_vector(std::string& text, const Vec3& v) {
  for (int axis = 0; axis < 3; ++axis) {
    text += ',';
    append_number(text, v[axis]);
  }
}

void append_body(std::string& text, Real time, const BodyView& body, const LiquidFields& fields) {
  std::string start;  // the same for every row of the body
  append_number(start, time);
  start += ',';
  append_csv_field(start, body.name);
  start += ',';
  start += to_string(body.kind);
  start += ',';
  for (std::size_t i = 0; i < body.positions.size(); ++i) {
    text += start;
    append_number(text, i);
    append_vector(text, body.positions[i]);
    append_vector(text, body.velocities[i]);
    text += ',';
    if (!fields.density.empty()) append_number(text, fields.density[i]);
    text += ',';
    if (!fields.pressure.empty()) append_number(text, fields.pressure[i]);
    text += '\n';
  }
}

class CsvWriter final : public FrameWriter {
 public:
  explicit CsvWriter(OutputFile file) : file_(std::move(file)) {}

  Status write(const Simulation& simulation) override {
    const std::vector<BodyView> bodies = simulation.bodies();
    const std::vector<LiquidFields> fields = simulation.liquid_fields();
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      text_.clear();
      append_body(text_, simulation.time(), bodies[i], fields[i]);
      if (Status written = file_.append(text_); !written) return written;
    }
    return {};
  }

  Status finish() override { return file_.commit(); }

 private:
  OutputFile file_;
  std::string text_;
};

}  // namespace

Result<std::unique_ptr<FrameWriter>> create_csv_writer(const std::string& name) {
  Result<OutputFile> file = OutputFile::create(name);
  if (!file) return file.errors();
  const Status written =
      file.value().append("time,body,kind,particle,x,y,z,vx,vy,vz,density,pressure\n");
  if (!written) return written.errors();
  return std::unique_ptr<FrameWriter>(std::make_unique<CsvWriter>(std::move(file).value()));
}

}  // namespace vat
