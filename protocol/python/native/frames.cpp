// The decoder of binary frames (protocol/FRAMES.md).

#include <pybind11/stl.h>

#include <string>
#include <string_view>

#include "protocol/frame/frame_codec.h"
#include "protocol/frame/frame_layout.h"
#include "protocol/python/native/bindings.h"
#include "protocol/python/native/frame_dict.h"

namespace py = pybind11;

namespace vat::python {
namespace {

std::vector<Real> positions_of(const FrameGrid& grid, const GridBlock& block) {
  std::vector<Real> positions(block.positions.size());
  for (std::size_t i = 0; i < positions.size(); i += 3) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      positions[i + axis] = grid.origin[axis] + block.positions[i + axis] * grid.quantum;
    }
  }
  return positions;
}

py::dict attributes_of(const FrameScale& scale, const GridBlock& block) {
  constexpr ByAttribute<const char*> kNames{"speed", "density", "pressure", "acceleration"};
  py::dict dict;
  for (std::size_t a = 0; a < kFrameAttributes; ++a) {
    if (block.attributes[a].empty()) continue;
    std::vector<Real> values(block.attributes[a].size());
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = block.attributes[a][i] * scale.attribute_quanta[a];
    }
    dict[kNames[a]] = own_array(std::move(values));
  }
  return dict;
}

std::vector<std::uint32_t> numbers_of(const GridBlock& block) {
  std::vector<std::uint32_t> numbers = block.numbers;
  for (std::size_t i = numbers.size(); i < block.particle_count(); ++i) {
    numbers.push_back(static_cast<std::uint32_t>(i));
  }
  return numbers;
}

py::dict body_of(const GridFrame& frame, const GridBlock& block) {
  py::dict dict;
  dict["id"] = block.body;
  if (block.has_particles()) {
    dict["kind"] = block.kind == GridBlock::Kind::liquid ? "liquid" : "deformable";
    dict["numbers"] = own_array(numbers_of(block));
    dict["positions"] = own_array(positions_of(frame.scale.grid, block), true);
    dict["attributes"] = attributes_of(frame.scale, block);
  } else {
    dict["kind"] = "rigid";
    dict["center_of_mass"] = place_of(frame, block);
    dict["orientation"] = orientation_of(block);
  }
  return dict;
}

}  // namespace

py::dict frame_dict(const GridFrame& frame) {
  py::dict dict;
  dict["number"] = frame.header.number;
  dict["epoch"] = frame.header.epoch;
  dict["tick"] = frame.header.tick;
  dict["time"] = frame.header.time;
  dict["published"] = frame.header.published;
  dict["playing"] = frame.header.playing;
  dict["slow"] = frame.header.slow;
  dict["real_time_factor"] = frame.header.real_time_factor;
  dict["detail"] = frame.detail;
  dict["has_region"] = frame.has_region;
  dict["quantum"] = frame.scale.grid.quantum;
  dict["vat_offset"] = py::none();
  py::list bodies;
  for (const GridBlock& block : frame.blocks) {
    if (block.kind == GridBlock::Kind::vat) {
      dict["vat_offset"] = place_of(frame, block);
    } else {
      bodies.append(body_of(frame, block));
    }
  }
  dict["bodies"] = bodies;
  return dict;
}

void bind_frames(py::module_& module) {
  py::class_<FrameDecoder>(module, "FrameDecoder")
      .def(py::init())
      .def("decode", [](FrameDecoder& decoder, const py::bytes& bytes) {
        return frame_dict(*value_of(decoder.decode(bytes_of(bytes))));
      });
  module.def("frame_number", [](const py::bytes& bytes) {
    const std::span<const std::uint8_t> frame = bytes_of(bytes);
    if (frame.size() < frame_layout::kHeaderSize) throw py::value_error("the frame is incomplete");
    return frame_number(frame);
  });
}

}  // namespace vat::python
