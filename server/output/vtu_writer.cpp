#include <lz4.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "protocol/files/text.h"
#include "server/output/bytes.h"
#include "server/output/frame_formats.h"
#include "server/output/series_writer.h"

namespace vat {

namespace {

/// Bytes that are compressed together. VTK decompresses blocks separately.
constexpr std::size_t kBlockBytes = 256 * 1024;

/// The arrays of a file: their descriptions in XML, and their compressed bytes.
class VtuArrays {
 public:
  template <class Number>
  void add(const std::string& name, const char* type, int components,
           const std::vector<Number>& values) {
    xml_ += "<DataArray type=\"" + std::string(type) + "\" Name=\"" + name +
            "\" NumberOfComponents=\"" + std::to_string(components) +
            "\" format=\"appended\" offset=\"" + std::to_string(bytes_.size()) + "\"/>\n";
    add_blocks({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Number)});
  }
  void open(const char* element) { xml_ += '<' + std::string(element) + ">\n"; }
  void close(const char* element) { xml_ += "</" + std::string(element) + ">\n"; }

  const std::string& xml() const { return xml_; }
  const std::string& bytes() const { return bytes_; }

 private:
  /// Appends the number of blocks, their size, the size of an incomplete last block, the compressed
  /// sizes, and the compressed blocks.
  void add_blocks(std::span<const char> data) {
    const std::size_t count = (data.size() + kBlockBytes - 1) / kBlockBytes;
    append_bytes(bytes_, std::uint64_t{count});
    append_bytes(bytes_, std::uint64_t{kBlockBytes});
    append_bytes(bytes_, std::uint64_t{data.size() % kBlockBytes});
    std::size_t size_at = bytes_.size();
    bytes_.resize(size_at + count * sizeof(std::uint64_t));
    for (; !data.empty(); size_at += sizeof(std::uint64_t)) {
      const std::span block = data.first(std::min(kBlockBytes, data.size()));
      const std::uint64_t size = add_block(block);
      std::memcpy(bytes_.data() + size_at, &size, sizeof size);
      data = data.subspan(block.size());
    }
  }

  std::uint64_t add_block(std::span<const char> block) {
    const std::size_t begin = bytes_.size();
    const int size = static_cast<int>(block.size());
    bytes_.resize(begin + static_cast<std::size_t>(LZ4_compressBound(size)));
    const int compressed = LZ4_compress_default(block.data(), bytes_.data() + begin, size,
                                                static_cast<int>(bytes_.size() - begin));
    VAT_CHECK(compressed > 0);
    bytes_.resize(begin + static_cast<std::size_t>(compressed));
    return static_cast<std::uint64_t>(compressed);
  }

  std::string xml_;
  std::string bytes_;
};

/// Returns the values of all particles, body after body.
template <class Number, class Values>
std::vector<Number> of_particles(const Simulation& simulation, std::size_t components,
                                 const Values& values) {
  std::vector<Number> all;
  all.reserve(components * simulation.particle_count());
  for (const BodyView& body : simulation.bodies()) values(body, all);
  return all;
}

void append_vectors(std::vector<Real>& all, std::span<const Vec3> vectors) {
  for (const Vec3& vector : vectors) all.insert(all.end(), vector.data(), vector.data() + 3);
}

/// Bodies that are not liquid have no fields. Readers need a value for each particle.
void append_field(std::vector<Real>& all, std::size_t count, const std::vector<Real>& field) {
  if (field.empty()) return all.resize(all.size() + count);
  all.insert(all.end(), field.begin(), field.end());
}

void add_attributes(VtuArrays& arrays, const Simulation& simulation) {
  std::vector<std::uint32_t> bodies;
  std::vector<std::uint8_t> kinds;
  std::vector<Real> densities;
  std::vector<Real> pressures;
  std::uint32_t number = 0;
  for (const BodyView& body : simulation.bodies()) {
    const std::size_t count = body.positions.size();
    bodies.insert(bodies.end(), count, number++);
    kinds.insert(kinds.end(), count, static_cast<std::uint8_t>(body.kind));
    const LiquidFields fields = liquid_fields_of(simulation, body);
    append_field(densities, count, fields.density);
    append_field(pressures, count, fields.pressure);
  }
  arrays.add("body", "UInt32", 1, bodies);
  arrays.add("kind", "UInt8", 1, kinds);
  arrays.add("density", "Float64", 1, densities);
  arrays.add("pressure", "Float64", 1, pressures);
  arrays.add("radius", "Float64", 1,
             of_particles<Real>(simulation, 1, [](const BodyView& body, std::vector<Real>& all) {
               all.insert(all.end(), body.radii.begin(), body.radii.end());
             }));
  arrays.add("velocity", "Float64", 3,
             of_particles<Real>(simulation, 3, [](const BodyView& body, std::vector<Real>& all) {
               append_vectors(all, body.velocities);
             }));
}

/// One cell has all points, because viewers display points of cells only.
void add_cell(VtuArrays& arrays, std::size_t count) {
  std::vector<std::int32_t> points(count);
  std::iota(points.begin(), points.end(), 0);
  const std::size_t cells = count == 0 ? 0 : 1;
  constexpr std::uint8_t kPolyVertex = 2;
  arrays.add("connectivity", "Int32", 1, points);
  arrays.add("offsets", "Int32", 1, std::vector(cells, static_cast<std::int32_t>(count)));
  arrays.add("types", "UInt8", 1, std::vector(cells, kPolyVertex));
}

std::string vtu_content(const Simulation& simulation) {
  const std::size_t count = simulation.particle_count();
  VtuArrays arrays;
  arrays.open("Points");
  arrays.add("Points", "Float64", 3,
             of_particles<Real>(simulation, 3, [](const BodyView& body, std::vector<Real>& all) {
               append_vectors(all, body.positions);
             }));
  arrays.close("Points");
  arrays.open("Cells");
  add_cell(arrays, count);
  arrays.close("Cells");
  arrays.open("PointData");
  add_attributes(arrays, simulation);
  arrays.close("PointData");

  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
      "byte_order=\"LittleEndian\" header_type=\"UInt64\" compressor=\"vtkLZ4DataCompressor\">\n"
      "<UnstructuredGrid>\n<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" "
      "NumberOfTuples=\"1\" format=\"ascii\">";
  append_number(text, simulation.time());
  text += "</DataArray>\n</FieldData>\n<Piece NumberOfPoints=\"" + std::to_string(count) +
          "\" NumberOfCells=\"" + (count == 0 ? "0" : "1") + "\">\n" + arrays.xml() +
          "</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";
  text += arrays.bytes();
  return text + "\n</AppendedData>\n</VTKFile>\n";
}

class VtuWriter final : public SeriesWriter {
 public:
  using SeriesWriter::SeriesWriter;

 protected:
  std::string content(const Simulation& simulation) const override {
    return vtu_content(simulation);
  }
};

/// Writes a list of the files of a series with their times, when they are complete.
class PvdWriter final : public FrameWriter {
 public:
  PvdWriter(OutputFile list, const std::string& vtu_name, std::size_t frame_count)
      : list_(std::move(list)),
        vtu_name_(vtu_name),
        frame_count_(frame_count),
        files_(vtu_name, frame_count) {}

  Status write(const Simulation& simulation) override {
    const std::string file = series_name(vtu_name_, frames_++, frame_count_);
    entries_ += "<DataSet timestep=\"";
    append_number(entries_, simulation.time());
    entries_ += "\" file=\"" + xml_text(std::filesystem::path(file).filename().string()) + "\"/>\n";
    return files_.write(simulation);
  }

  Status finish() override {
    const Status written = list_.append(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n<Collection>\n" +
        entries_ + "</Collection>\n</VTKFile>\n");
    return written ? list_.commit() : written;
  }

 private:
  /// Returns the text with references in place of the characters that XML reserves.
  static std::string xml_text(const std::string& text) {
    std::string safe;
    for (const char c : text) {
      if (c == '&') {
        safe += "&amp;";
      } else if (c == '<') {
        safe += "&lt;";
      } else if (c == '"') {
        safe += "&quot;";
      } else {
        safe += c;
      }
    }
    return safe;
  }

  OutputFile list_;
  std::string vtu_name_;
  std::size_t frame_count_;
  VtuWriter files_;
  std::size_t frames_ = 0;
  std::string entries_;
};

}  // namespace

Result<std::unique_ptr<FrameWriter>> create_pvd_writer(const std::string& name,
                                                       std::size_t frame_count) {
  Result<OutputFile> list = OutputFile::create(name);
  if (!list) return list.errors();
  const std::string vtu_name = std::filesystem::path(name).replace_extension(".vtu").string();
  return std::unique_ptr<FrameWriter>(
      std::make_unique<PvdWriter>(std::move(list).value(), vtu_name, frame_count));
}

}  // namespace vat
