#include <lz4.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
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

/// The arrays of a file: their descriptions in XML, and their compressed bytes. An array passes
/// through a buffer of one block, which stays in the cache of the processor.
class VtuArrays {
 public:
  void clear() {
    xml_.clear();
    bytes_.clear();
  }

  /// Adds an array. `add_values` calls append() or repeat() for `count` numbers.
  template <class Number, class Add>
  void add(const char* name, const char* type, int components, std::size_t count,
           Add&& add_values) {
    xml_ += "<DataArray type=\"" + std::string(type) + "\" Name=\"" + name +
            "\" NumberOfComponents=\"" + std::to_string(components) +
            "\" format=\"appended\" offset=\"" + std::to_string(bytes_.size()) + "\"/>\n";
    begin_array(count * sizeof(Number));
    add_values();
    end_array();
  }
  void open(const char* element) { xml_ += '<' + std::string(element) + ">\n"; }
  void close(const char* element) { xml_ += "</" + std::string(element) + ">\n"; }

  /// Appends numbers or vectors to the current array.
  template <class Value>
  void append(std::span<const Value> values) {
    const auto* bytes = reinterpret_cast<const char*>(values.data());
    for (std::size_t left = values.size_bytes(); left > 0;) {
      const std::size_t part = std::min(left, kBlockBytes - block_size_);
      std::memcpy(block_.data() + block_size_, bytes, part);
      block_size_ += part;
      bytes += part;
      left -= part;
      if (block_size_ == kBlockBytes) end_block();
    }
  }
  template <class Number>
  void append_one(Number value) {
    append(std::span<const Number>(&value, 1));
  }
  template <class Number>
  void repeat(Number value, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) append_one(value);
  }

  const std::string& xml() const { return xml_; }
  const std::string& bytes() const { return bytes_; }

 private:
  /// Appends the number of blocks, their size, the size of an incomplete last block, and room for
  /// the compressed sizes. The compressed blocks follow.
  void begin_array(std::size_t size) {
    const std::size_t count = (size + kBlockBytes - 1) / kBlockBytes;
    append_bytes(bytes_, std::uint64_t{count});
    append_bytes(bytes_, std::uint64_t{kBlockBytes});
    append_bytes(bytes_, std::uint64_t{size % kBlockBytes});
    size_at_ = bytes_.size();
    last_size_at_ = size_at_ + count * sizeof(std::uint64_t);
    bytes_.resize(last_size_at_);
  }

  void end_array() {
    if (block_size_ > 0) end_block();
    VAT_CHECK(size_at_ == last_size_at_);
  }

  void end_block() {
    const std::size_t begin = bytes_.size();
    const int size = static_cast<int>(block_size_);
    bytes_.resize(begin + static_cast<std::size_t>(LZ4_compressBound(size)));
    const int compressed = LZ4_compress_default(block_.data(), bytes_.data() + begin, size,
                                                static_cast<int>(bytes_.size() - begin));
    VAT_CHECK(compressed > 0);
    bytes_.resize(begin + static_cast<std::size_t>(compressed));
    const std::uint64_t compressed_size = static_cast<std::uint64_t>(compressed);
    std::memcpy(bytes_.data() + size_at_, &compressed_size, sizeof compressed_size);
    size_at_ += sizeof compressed_size;
    block_size_ = 0;
  }

  std::string xml_;
  std::string bytes_;
  std::vector<char> block_ = std::vector<char>(kBlockBytes);
  std::size_t block_size_ = 0;
  std::size_t size_at_ = 0;       ///< of the size of the current block in `bytes_`
  std::size_t last_size_at_ = 0;  ///< end of the sizes of the current array
};

/// Adds vectors of all particles, body after body.
void add_vectors(VtuArrays& arrays, const char* name, const std::vector<BodyView>& bodies,
                 std::size_t count, std::span<const Vec3> BodyView::*vectors) {
  static_assert(sizeof(Vec3) == 3 * sizeof(Real));
  arrays.add<Real>(name, "Float64", 3, 3 * count, [&] {
    for (const BodyView& body : bodies) arrays.append(body.*vectors);
  });
}

/// Adds density or pressure. Bodies that are not liquid have no fields. Readers need a value for
/// each particle.
void add_field(VtuArrays& arrays, const char* name, const std::vector<BodyView>& bodies,
               const std::vector<LiquidFields>& fields, std::size_t count,
               std::vector<Real> LiquidFields::*field) {
  arrays.add<Real>(name, "Float64", 1, count, [&] {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const std::vector<Real>& values = fields[i].*field;
      if (values.empty()) {
        arrays.repeat(Real{0}, bodies[i].positions.size());
      } else {
        arrays.append(std::span(values));
      }
    }
  });
}

void add_attributes(VtuArrays& arrays, const Simulation& simulation,
                    const std::vector<BodyView>& bodies, std::size_t count) {
  arrays.add<std::uint32_t>("body", "UInt32", 1, count, [&] {
    std::uint32_t number = 0;
    for (const BodyView& body : bodies) arrays.repeat(number++, body.positions.size());
  });
  arrays.add<std::uint8_t>("kind", "UInt8", 1, count, [&] {
    for (const BodyView& body : bodies) {
      arrays.repeat(static_cast<std::uint8_t>(body.kind), body.positions.size());
    }
  });
  const std::vector<LiquidFields> fields = simulation.liquid_fields();
  add_field(arrays, "density", bodies, fields, count, &LiquidFields::density);
  add_field(arrays, "pressure", bodies, fields, count, &LiquidFields::pressure);
  arrays.add<Real>("radius", "Float64", 1, count, [&] {
    for (const BodyView& body : bodies) arrays.append(body.radii);
  });
  add_vectors(arrays, "velocity", bodies, count, &BodyView::velocities);
}

/// One cell has all points, because viewers display points of cells only.
void add_cell(VtuArrays& arrays, std::size_t count) {
  const std::size_t cells = count == 0 ? 0 : 1;
  constexpr std::uint8_t kPolyVertex = 2;
  arrays.add<std::int32_t>("connectivity", "Int32", 1, count, [&] {
    for (std::size_t i = 0; i < count; ++i) arrays.append_one(static_cast<std::int32_t>(i));
  });
  arrays.add<std::int32_t>("offsets", "Int32", 1, cells,
                           [&] { arrays.repeat(static_cast<std::int32_t>(count), cells); });
  arrays.add<std::uint8_t>("types", "UInt8", 1, cells, [&] { arrays.repeat(kPolyVertex, cells); });
}

void add_all(VtuArrays& arrays, const Simulation& simulation, std::size_t count) {
  const std::vector<BodyView> bodies = simulation.bodies();
  arrays.clear();
  arrays.open("Points");
  add_vectors(arrays, "Points", bodies, count, &BodyView::positions);
  arrays.close("Points");
  arrays.open("Cells");
  add_cell(arrays, count);
  arrays.close("Cells");
  arrays.open("PointData");
  add_attributes(arrays, simulation, bodies, count);
  arrays.close("PointData");
}

/// Returns the part of the file before the arrays.
std::string vtu_start(const Simulation& simulation, const VtuArrays& arrays, std::size_t count) {
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
      "byte_order=\"LittleEndian\" header_type=\"UInt64\" compressor=\"vtkLZ4DataCompressor\">\n"
      "<UnstructuredGrid>\n<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" "
      "NumberOfTuples=\"1\" format=\"ascii\">";
  append_number(text, simulation.time());
  text += "</DataArray>\n</FieldData>\n<Piece NumberOfPoints=\"" + std::to_string(count) +
          "\" NumberOfCells=\"" + (count == 0 ? "0" : "1") + "\">\n" + arrays.xml() +
          "</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";
  return text;
}

class VtuWriter final : public SeriesWriter {
 public:
  using SeriesWriter::SeriesWriter;

 protected:
  Status write_content(const Simulation& simulation, OutputFile& file) override {
    const std::size_t count = simulation.particle_count();
    add_all(arrays_, simulation, count);
    const std::string start = vtu_start(simulation, arrays_, count);
    if (Status written = file.append(start); !written) return written;
    if (Status written = file.append(arrays_.bytes()); !written) return written;
    return file.append("\n</AppendedData>\n</VTKFile>\n");
  }

 private:
  VtuArrays arrays_;  // keeps its memory
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
