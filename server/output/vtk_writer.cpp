#include "server/output/frame_formats.h"

#include <functional>
#include <vector>

#include "server/output/series_writer.h"
#include "server/output/text.h"

namespace vat {

namespace {

/// The text of one file. Every attribute is one pass over all particles, body after body.
class VtkText {
 public:
  explicit VtkText(const Simulation& simulation)
      : bodies_(simulation.bodies()), count_(simulation.particle_count()) {
    for (const BodyView& body : bodies_) fields_.push_back(liquid_fields_of(simulation, body));
    add_geometry(simulation.time());
    add_attributes();
  }

  const std::string& text() const { return text_; }

 private:
  using Value = std::function<void(std::size_t body, std::size_t particle)>;

  void add_geometry(Real time) {
    text_ = "# vtk DataFile Version 3.0\nparticles of vat, SI units\nASCII\nDATASET POLYDATA\n";
    text_ += "FIELD FieldData 1\nTIME 1 1 double\n";
    append_number(text_, time);
    text_ += "\nPOINTS " + std::to_string(count_) + " double\n";
    add_rows([&](auto b, auto i) { add_vector(bodies_[b].positions[i]); });
    text_ += "VERTICES " + std::to_string(count_) + ' ' + std::to_string(2 * count_) + '\n';
    for (std::size_t i = 0; i < count_; ++i) text_ += "1 " + std::to_string(i) + '\n';
  }

  void add_attributes() {
    text_ += "POINT_DATA " + std::to_string(count_) + '\n';
    add_scalars("body", "unsigned_int", [&](auto b, auto) { append_number(text_, b); });
    add_scalars("kind", "unsigned_char", [&](auto b, auto) {
      append_number(text_, static_cast<unsigned>(bodies_[b].kind));
    });
    add_scalars("radius", "double",
                [&](auto b, auto i) { append_number(text_, bodies_[b].radii[i]); });
    add_scalars("density", "double", [&](auto b, auto i) { add_field(fields_[b].density, i); });
    add_scalars("pressure", "double", [&](auto b, auto i) { add_field(fields_[b].pressure, i); });
    text_ += "VECTORS velocity double\n";
    add_rows([&](auto b, auto i) { add_vector(bodies_[b].velocities[i]); });
  }

  void add_scalars(const char* name, const char* type, const Value& value) {
    text_ += std::string("SCALARS ") + name + ' ' + type + " 1\nLOOKUP_TABLE default\n";
    add_rows(value);
  }

  void add_rows(const Value& value) {
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      for (std::size_t i = 0; i < bodies_[b].positions.size(); ++i) {
        value(b, i);
        text_ += '\n';
      }
    }
  }

  void add_vector(const Vec3& v) {
    append_number(text_, v.x());
    text_ += ' ';
    append_number(text_, v.y());
    text_ += ' ';
    append_number(text_, v.z());
  }

  // A body that is not a liquid has no such field; readers want a value all the same.
  void add_field(const std::vector<Real>& field, std::size_t i) {
    append_number(text_, field.empty() ? 0.0 : field[i]);
  }

  std::vector<BodyView> bodies_;
  std::vector<LiquidFields> fields_;
  std::size_t count_;
  std::string text_;
};

class VtkWriter final : public SeriesWriter {
 public:
  using SeriesWriter::SeriesWriter;

 protected:
  std::string content(const Simulation& simulation) const override {
    return VtkText(simulation).text();
  }
};

}  // namespace

Result<std::unique_ptr<FrameWriter>> create_vtk_writer(const std::string& name,
                                                       std::size_t frame_count) {
  return std::unique_ptr<FrameWriter>(std::make_unique<VtkWriter>(name, frame_count));
}

}  // namespace vat
