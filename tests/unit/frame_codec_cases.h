#pragma once

#include <fstream>
#include <iterator>
#include <ostream>
#include <string>
#include <vector>

#include "protocol/frame_codec.h"
#include "protocol/json_reader.h"

/// The golden frames: what is encoded, and where the files are. Web tests read the same files.
namespace vat::frame_cases {

struct FrameCase {
  std::string name;  ///< of the files, without ending
  PublishedState state;
  FrameGrid grid;
  std::uint32_t sequence = 1;
  std::uint32_t dropped = 0;
};

inline void PrintTo(const FrameCase& frame, std::ostream* out) {
  *out << frame.name;
}

inline PublishedState::Body liquid_body() {
  return {1, BodyKind::liquid, {{0.1, 0.2, 0.3}, {0.25, 0, 1.9999}, {0, 0, 0}}, {}, {1, 0, 0, 0}};
}
inline PublishedState::Body deformable_body() {
  return {2, BodyKind::deformable, {{1.5, 0.5, 0.75}, {1.5, 0.5, 0.85}}, {}, {1, 0, 0, 0}};
}
inline PublishedState::Body rigid_body() {
  return {3, BodyKind::rigid, {}, {0.5, -0.25, 1.0 / 3.0}, {0.5F, -0.5F, 0.5F, 0.5F}};
}

inline FrameCase make_case(std::string name, std::vector<PublishedState::Body> bodies) {
  FrameCase result;
  result.name = std::move(name);
  result.state.header.playing = true;
  result.state.header.epoch = 2;
  result.state.header.tick = 77;
  result.state.header.time = 1.54;
  result.state.header.published = 1.7e9 + 0.125;
  result.state.header.real_time_factor = 0.75F;
  result.state.bodies = std::move(bodies);
  result.grid = make_frame_grid({0, 0, 0}, {2, 1, 2}, 0);
  result.sequence = 9;
  return result;
}

/// Every header field at its greatest, the grid's last positions, ones outside it, ids of 32 bits.
inline FrameCase largest_case() {
  FrameCase result = make_case("v1-largest", {});
  FrameHeader& header = result.state.header;
  header.slow = true;
  header.epoch = 0xffffffffU;
  header.tick = (std::uint64_t{1} << 53) - 1;  // the greatest that JSON readers keep exactly
  header.time = 1e12;
  header.published = 4e9;
  header.real_time_factor = 3.0e38F;
  result.sequence = 0xffffffffU;
  result.dropped = 0xfffffffeU;
  result.grid = make_frame_grid({-1e6, -1e6, -1e6}, {1e6, 1e6, 1e6}, 0);
  const std::vector<Vec3> corners{{1e6, 1e6, 1e6}, {-1e6, -1e6, -1e6}, {2e6, -2e6, 0}};
  result.state.bodies.push_back({0xffffffffU, BodyKind::liquid, corners, {}, {1, 0, 0, 0}});
  result.state.bodies.push_back(
      {0xfffffffeU, BodyKind::rigid, {}, {1e6, -1e6, 1e6}, {0, 0, 0, -1}});
  return result;
}

inline std::vector<FrameCase> all_cases() {
  std::vector<FrameCase> cases{
      make_case("v1-empty", {}),
      make_case("v1-liquid", {liquid_body()}),
      make_case("v1-deformable", {deformable_body()}),
      make_case("v1-rigid", {rigid_body()}),
      make_case("v1-vat", {}),
      make_case("v1-all", {liquid_body(), deformable_body(), rigid_body()}),
      largest_case()};
  for (FrameCase& frame : cases) {
    if (frame.name != "v1-vat" && frame.name != "v1-all") continue;
    frame.state.has_vat = true;
    frame.state.vat_offset = {0.125, 0, -1.0 / 3.0};
  }
  cases.front().state.header.playing = false;
  return cases;
}

inline std::vector<std::uint8_t> encode(const FrameCase& frame) {
  std::vector<std::uint8_t> bytes = encode_key_frame(frame.state, frame.grid);
  patch_client(bytes, frame.sequence, frame.dropped);
  return bytes;
}

inline std::string golden_path(const std::string& file) {
  return std::string(VAT_SOURCE_DIR) + "/tests/golden/frames/" + file;
}

/// Empty where the file cannot be read.
inline std::string read_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline std::vector<std::uint8_t> read_bytes(const std::string& path) {
  const std::string text = read_text(path);
  return {text.begin(), text.end()};
}

}  // namespace vat::frame_cases
