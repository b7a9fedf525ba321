#pragma once

#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include "protocol/frame/frame_codec.h"

/// Frames that tests encode, and the golden files. Web tests read the same files.
namespace vat::frame_cases {

/// A random generator with numbers in [0, 1) that are the same on all machines.
class Chance {
 public:
  explicit Chance(std::uint32_t seed) : state_(seed) {}
  double next() {
    state_ = state_ * 1664525 + 1013904223;
    return (state_ >> 8) / 16777216.0;
  }

 private:
  std::uint32_t state_;
};

/// A world of all kinds of bodies that moves, emits and drains.
class World {
 public:
  explicit World(std::uint32_t particles = 64, std::uint32_t seed = 1) : chance_(seed) {
    const auto edge = static_cast<std::uint32_t>(std::ceil(std::cbrt(particles)));
    for (std::uint32_t i = 0; i < particles; ++i) {
      const std::uint32_t row = i / edge;
      const std::uint32_t layer = row / edge;
      const Vec3 cell(i % edge, row % edge, layer);
      add_drop(Vec3(0.2, 0.2, 0.1) + 0.05 * cell);
    }
    for (std::uint32_t i = 0; i < 12; ++i) {
      const std::uint32_t row = i / 3;
      jelly_.push_back({{1.2 + 0.1 * (i % 3), 0.5 + 0.1 * row, 0.75}, {0.3, 0, 0.1}, i});
    }
  }

  /// Advances by `frames` thirtieths of a second. Nearby particles move similarly.
  void advance(int frames) {
    for (int f = 0; f < frames; ++f, ++frame_) {
      for (Drop& drop : drops_) {
        const Vec3& x = drop.position;
        drop.velocity += Vec3(0.2 * x.z(), -0.1 * x.x(), -0.15) / 30;
        move(drop);
      }
      for (Drop& drop : jelly_) move(drop);
      turn_ += 0.05;
    }
  }
  /// Adds drops at the tap.
  void pour(std::uint32_t count) {
    for (std::uint32_t i = 0; i < count; ++i) add_drop({0.1 + 0.05 * (i % 4), 0.9, 1.5});
  }
  /// Removes drops within `reach` of the drain.
  void drain(double reach) {
    std::erase_if(drops_, [&](const Drop& drop) { return drop.position.x() < reach; });
  }
  /// Advances the time only.
  void wait(int frames) { frame_ += frames; }

  PublishedState state() const {
    PublishedState state;
    state.header.playing = true;
    state.header.epoch = 2;
    state.header.number = static_cast<std::uint32_t>(10 + frame_);
    state.header.tick = 70 + 2 * static_cast<std::uint64_t>(frame_);
    state.header.time = frame_ / 30.0;
    state.header.published = 1.7e9 + frame_ / 32.0;
    state.header.real_time_factor = 0.75F;
    state.has_vat = true;
    state.vat_offset = {0.125 * std::sin(turn_), 0, -1.0 / 3.0};
    state.bodies.resize(3);
    put(drops_, state.bodies[0]);
    state.bodies[0].id = 1;
    put(jelly_, state.bodies[1]);
    state.bodies[1].id = 2;
    state.bodies[1].kind = BodyKind::deformable;
    PublishedState::Body& stone = state.bodies[2];
    stone.id = 3;
    stone.kind = BodyKind::rigid;
    stone.center_of_mass = {0.5 + 0.2 * turn_, -0.25, 1.0 / 3.0};
    stone.orientation = {std::cos(turn_), 0, std::sin(turn_), 0};
    stone.bounding_radius = 0.2;
    return state;
  }

 private:
  struct Drop {
    Vec3 position;
    Vec3 velocity;
    std::uint32_t number = 0;
  };
  void add_drop(const Vec3& position) {
    drops_.push_back({position, {0.6, 0.2, -0.1}, next_number_++});
  }
  void move(Drop& drop) {
    for (int axis = 0; axis < 3; ++axis) {
      drop.position[axis] += drop.velocity[axis] / 30 + 0.0006 * (chance_.next() - 0.5);
    }
  }
  static void put(const std::vector<Drop>& drops, PublishedState::Body& body) {
    for (const Drop& drop : drops) {
      body.positions.push_back(drop.position);
      body.numbers.push_back(drop.number);
      body.attributes[0].push_back(static_cast<float>(drop.velocity.norm()));
      body.attributes[1].push_back(static_cast<float>(1000 + drop.position.z()));
      body.attributes[2].push_back(static_cast<float>(1e4 * (1 - drop.position.z())));
      body.attributes[3].push_back(static_cast<float>(5 + 4 * std::sin(9 * drop.position.x())));
    }
  }

  Chance chance_;
  std::vector<Drop> drops_;
  std::vector<Drop> jelly_;
  std::uint32_t next_number_ = 0;
  int frame_ = 0;
  double turn_ = 0.1;
};

inline FrameScale plain_scale(double max_error = 1e-3) {
  return {make_frame_grid({-0.5, -0.5, -0.5}, {3, 2, 2}, max_error), {}};
}
inline FrameScale scale_with_attributes() {
  FrameScale scale = plain_scale();
  scale.attribute_quanta = {0.01, 0.001, 5};
  return scale;
}

inline FrameScale scale_with_accelerations() {
  FrameScale scale = plain_scale();
  scale.attribute_quanta = {0.01, 0, 0, 0.02};
  return scale;
}

inline GridFrame on_grid(const PublishedState& state, const FrameScale& scale) {
  GridFrame frame;
  make_grid_frame(state, scale, frame);
  return frame;
}
inline GridFrame part_of(const GridFrame& all, const FrameSelection& selection) {
  GridFrame part;
  select_particles(all, selection, part);
  return part;
}

/// A frame of a stream, and the earlier frames that it refers to.
struct Step {
  std::string name;
  GridFrame frame;
  std::optional<std::size_t> first{};
  std::optional<std::size_t> second{};
  std::uint8_t stride = 1;
};
using Stream = std::vector<Step>;

inline std::vector<std::uint8_t> encode(const Stream& stream, std::size_t index) {
  const Step& step = stream.at(index);
  FrameReferences references;
  if (step.first) references.first = &stream.at(*step.first).frame;
  if (step.second) references.second = &stream.at(*step.second).frame;
  FrameEncoder encoder;
  const auto bytes = encoder.encode(step.frame, references, step.stride);
  return {bytes.begin(), bytes.end()};
}

/// A stream of one client that contains everything a client can receive.
inline Stream moving_stream() {
  World world;
  const FrameScale scale = plain_scale();
  Stream stream;
  const auto show = [&](const char* name, std::optional<std::size_t> first,
                        std::optional<std::size_t> second, const FrameSelection& selection = {}) {
    stream.push_back({name, part_of(on_grid(world.state(), scale), selection), first, second});
  };
  show("v2-key", {}, {});
  world.advance(2);
  show("v2-delta-one", 0, {});
  world.advance(1);
  show("v2-delta-two", 1, 0);
  world.advance(4);
  show("v2-dropped", 2, 0);
  stream.back().stride = 2;
  world.wait(3);
  show("v2-rest", 3, 2);
  world.pour(9);
  world.drain(0.45);
  world.advance(1);
  show("v2-flow", 4, 3);
  world.advance(1);
  show("v2-detail", 5, 4, {1, {}});
  world.advance(1);
  show("v2-region", 6, 5, {kFullDetail, FrameRegion{{0, 0, 0}, {0.7, 1, 2}}});
  world.advance(1);
  show("v2-all-again", 7, 6);
  return stream;
}

/// Returns the frames "v2-NAME", "v2-NAME-one" and "v2-NAME-two".
inline Stream attribute_stream(const std::string& name, const FrameScale& scale) {
  World world(40, 5);
  Stream stream;
  const auto show = [&](const char* end, std::optional<std::size_t> first,
                        std::optional<std::size_t> second) {
    stream.push_back({"v2-" + name + end, on_grid(world.state(), scale), first, second});
  };
  show("", {}, {});
  world.advance(1);
  show("-one", 0, {});
  world.advance(1);
  world.pour(3);
  world.drain(0.25);
  show("-two", 1, 0);
  return stream;
}

/// Returns frames without blocks, with every field at its maximum, with positions at the ends of
/// the grid and outside it.
inline Stream edge_stream() {
  PublishedState empty;
  empty.header.number = 1;
  Stream stream{{"v2-empty", on_grid(empty, plain_scale()), {}, {}}};
  PublishedState state;
  FrameHeader& header = state.header;
  header.playing = header.slow = true;
  header.epoch = header.number = 0xffffffffU;
  header.tick = (std::uint64_t{1} << 53) - 1;  // the largest integer that JSON readers keep exactly
  header.time = 1e12;
  header.published = 4e9;
  header.real_time_factor = 3.0e38F;
  state.bodies.resize(2);
  PublishedState::Body& liquid = state.bodies[0];
  liquid.id = 0xffffffffU;
  liquid.positions = {{1e6, 1e6, 1e6}, {-1e6, -1e6, -1e6}, {2e6, -2e6, 0}};
  liquid.numbers = {0, 7, 0xffffffffU};
  for (auto& column : liquid.attributes) column = {0, 3e38F, -3e38F};
  PublishedState::Body& rigid = state.bodies[1];
  rigid.id = 0xfffffffeU;
  rigid.kind = BodyKind::rigid;
  rigid.center_of_mass = {1e12, -1e12, 1e6};
  rigid.orientation = {0, 0, 0, -1};
  rigid.bounding_radius = 1e6;
  const FrameGrid grid = make_frame_grid({-1e6, -1e6, -1e6}, {1e6, 1e6, 1e6}, 0);
  stream.push_back({"v2-largest", on_grid(state, {grid, {1e-3, 1e-3, 1e-3}}), {}, {}});
  stream.back().stride = 255;
  return stream;
}

inline std::string golden_path(const std::string& file) {
  return std::string(VAT_SOURCE_DIR) + "/tests/golden/frames/" + file;
}

/// Returns the content of a file; empty if it cannot be read.
inline std::string read_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline std::vector<std::uint8_t> read_bytes(const std::string& path) {
  const std::string text = read_text(path);
  return {text.begin(), text.end()};
}

}  // namespace vat::frame_cases
