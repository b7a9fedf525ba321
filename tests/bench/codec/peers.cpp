#include "tests/bench/codec/peers.h"

#include <chrono>
#include <cstring>
#include <functional>
#include <stdexcept>

#include "tests/bench/codec/measure.h"
#include "tests/bench/report/quantile.h"

#ifdef VAT_HAS_ZSTD
#include <zstd.h>
#endif
#ifdef VAT_HAS_MESHOPTIMIZER
#include <meshoptimizer.h>
#endif
#ifdef VAT_HAS_DRACO
#include <draco/compression/decode.h>
#include <draco/compression/encode.h>
#include <draco/point_cloud/point_cloud_builder.h>
#endif

namespace vat::bench {
namespace {

using Positions = std::vector<std::uint16_t>;
using Bytes = std::vector<std::uint8_t>;

/// Encodes and decodes positions. `before` are the positions of the previous frame with the same
/// number of particles, or empty.
struct Peer {
  const char* name;
  const char* what;
  std::function<Bytes(const Positions& positions, const Positions& before)> encode;
  std::function<Positions(const Bytes& bytes, const Positions& before)> decode;
};

Bytes raw_bytes(const Positions& positions) {
  Bytes bytes(2 * positions.size());
  std::memcpy(bytes.data(), positions.data(), bytes.size());
  return bytes;
}

Positions raw_positions(const Bytes& bytes) {
  Positions positions(bytes.size() / 2);
  std::memcpy(positions.data(), bytes.data(), bytes.size());
  return positions;
}

Peer raw_peer() {
  return {"16 bits", "three numbers of 16 bits",
          [](const Positions& positions, const Positions&) { return raw_bytes(positions); },
          [](const Bytes& bytes, const Positions&) { return raw_positions(bytes); }};
}

#ifdef VAT_HAS_ZSTD
Bytes zstd_packed(const Bytes& plain, int level) {
  Bytes bytes(ZSTD_compressBound(plain.size()));
  const std::size_t size =
      ZSTD_compress(bytes.data(), bytes.size(), plain.data(), plain.size(), level);
  if (ZSTD_isError(size) != 0) throw std::runtime_error("zstd failed");
  bytes.resize(size);
  return bytes;
}

Bytes zstd_unpacked(const Bytes& bytes) {
  Bytes plain(ZSTD_getFrameContentSize(bytes.data(), bytes.size()));
  const std::size_t size = ZSTD_decompress(plain.data(), plain.size(), bytes.data(), bytes.size());
  if (ZSTD_isError(size) != 0 || size != plain.size()) throw std::runtime_error("zstd failed");
  return plain;
}

/// Returns the differences to the previous frame, first their low bytes and then their high bytes.
Bytes difference_planes(const Positions& positions, const Positions& before) {
  const std::size_t count = positions.size();
  Bytes planes(2 * count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto difference =
        static_cast<std::int16_t>(positions[i] - (before.empty() ? 0 : before[i]));
    const auto folded = static_cast<std::uint16_t>((difference * 2) ^ (difference >> 15));
    planes[i] = static_cast<std::uint8_t>(folded);
    planes[count + i] = static_cast<std::uint8_t>(folded >> 8);
  }
  return planes;
}

Positions from_planes(const Bytes& planes, const Positions& before) {
  Positions positions(planes.size() / 2);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const auto folded = static_cast<std::uint16_t>(planes[i] | planes[positions.size() + i] << 8);
    const int difference = (folded >> 1) ^ -(folded & 1);
    positions[i] = static_cast<std::uint16_t>(difference + (before.empty() ? 0 : before[i]));
  }
  return positions;
}

Peer zstd_peer() {
  return {"16 bits, zstd", "the same, zstd at level 9",
          [](const Positions& positions, const Positions&) {
            return zstd_packed(raw_bytes(positions), 9);
          },
          [](const Bytes& bytes, const Positions&) { return raw_positions(zstd_unpacked(bytes)); }};
}

Peer zstd_delta_peer() {
  return {"differences, zstd", "to the frame before, in byte planes, zstd at level 1",
          [](const Positions& positions, const Positions& before) {
            return zstd_packed(difference_planes(positions, before), 1);
          },
          [](const Bytes& bytes, const Positions& before) {
            return from_planes(zstd_unpacked(bytes), before);
          }};
}
#endif

#ifdef VAT_HAS_MESHOPTIMIZER
constexpr std::size_t kVertex = 8;  // meshoptimizer needs a multiple of four bytes

Bytes mesh_encoded(const Positions& positions) {
  const std::size_t count = positions.size() / 3;
  std::vector<std::uint16_t> vertices(4 * count);
  for (std::size_t i = 0; i < count; ++i) {
    std::copy_n(&positions[3 * i], 3, &vertices[4 * i]);
  }
  Bytes bytes(meshopt_encodeVertexBufferBound(count, kVertex));
  bytes.resize(
      meshopt_encodeVertexBuffer(bytes.data(), bytes.size(), vertices.data(), count, kVertex));
  Bytes sized(sizeof(count) + bytes.size());
  std::memcpy(sized.data(), &count, sizeof(count));
  std::memcpy(sized.data() + sizeof(count), bytes.data(), bytes.size());
  return sized;
}

Positions mesh_decoded(const Bytes& bytes) {
  std::size_t count = 0;
  std::memcpy(&count, bytes.data(), sizeof(count));
  std::vector<std::uint16_t> vertices(4 * count);
  if (meshopt_decodeVertexBuffer(vertices.data(), count, kVertex, bytes.data() + sizeof(count),
                                 bytes.size() - sizeof(count)) != 0) {
    throw std::runtime_error("meshoptimizer failed");
  }
  Positions positions(3 * count);
  for (std::size_t i = 0; i < count; ++i) {
    std::copy_n(&vertices[4 * i], 3, &positions[3 * i]);
  }
  return positions;
}

Peer meshoptimizer_peer() {
  return {"meshoptimizer", "vertex codec, four numbers of 16 bits",
          [](const Positions& positions, const Positions&) { return mesh_encoded(positions); },
          [](const Bytes& bytes, const Positions&) { return mesh_decoded(bytes); }};
}
#endif

#ifdef VAT_HAS_DRACO
Bytes draco_encoded(const Positions& positions) {
  const auto count = static_cast<draco::PointIndex::ValueType>(positions.size() / 3);
  draco::PointCloudBuilder builder;
  builder.Start(count);
  const int id = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_UINT16);
  builder.SetAttributeValuesForAllPoints(id, positions.data(), 3 * sizeof(std::uint16_t));
  draco::Encoder encoder;
  encoder.SetEncodingMethod(draco::POINT_CLOUD_SEQUENTIAL_ENCODING);  // keeps the order
  draco::EncoderBuffer buffer;
  if (!encoder.EncodePointCloudToBuffer(*builder.Finalize(false), &buffer).ok()) {
    throw std::runtime_error("Draco failed");
  }
  return {buffer.data(), buffer.data() + buffer.size()};
}

Positions draco_decoded(const Bytes& bytes) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  draco::Decoder decoder;
  auto cloud = decoder.DecodePointCloudFromBuffer(&buffer);
  if (!cloud.ok()) throw std::runtime_error("Draco failed");
  const draco::PointAttribute* attribute =
      cloud.value()->GetNamedAttribute(draco::GeometryAttribute::POSITION);
  Positions positions(std::size_t{3} * cloud.value()->num_points());
  for (draco::PointIndex i(0); i < cloud.value()->num_points(); ++i) {
    attribute->GetMappedValue(i, &positions[std::size_t{3} * i.value()]);
  }
  return positions;
}

Peer draco_peer() {
  return {"Draco", "sequential point cloud, which keeps the order",
          [](const Positions& positions, const Positions&) { return draco_encoded(positions); },
          [](const Bytes& bytes, const Positions&) { return draco_decoded(bytes); }};
}
#endif

Positions positions_of(const GridFrame& frame) {
  Positions positions;
  for (const GridBlock& block : frame.blocks) {
    positions.insert(positions.end(), block.positions.begin(), block.positions.end());
  }
  return positions;
}

PeerResult measure_peer(const Peer& peer, const std::vector<Positions>& frames) {
  using Clock = std::chrono::steady_clock;
  const auto seconds = [](Clock::time_point from) {
    return std::chrono::duration<Real>(Clock::now() - from).count();
  };
  std::vector<Real> encode;
  std::vector<Real> decode;
  Real bits = 0;
  for (std::size_t f = 1; f < frames.size(); ++f) {
    const auto count = static_cast<Real>(frames[f].size()) / 3;
    const Clock::time_point encoding = Clock::now();
    const Bytes bytes = peer.encode(frames[f], frames[f - 1]);
    encode.push_back(seconds(encoding) / count);
    const Clock::time_point decoding = Clock::now();
    const Positions decoded = peer.decode(bytes, frames[f - 1]);
    decode.push_back(seconds(decoding) / count);
    if (decoded != frames[f]) throw std::runtime_error(std::string(peer.name) + " loses something");
    bits += 8 * static_cast<Real>(bytes.size()) / count;
  }
  return {peer.name,      peer.what,     true, bits / static_cast<Real>(frames.size() - 1),
          median(encode), median(decode)};
}

[[maybe_unused]] PeerResult missing(const char* name) {
  return {name, "not built in: its library was not there", false, 0, 0, 0};
}

}  // namespace

std::vector<PeerResult> measure_peers(const std::vector<GridFrame>& frames) {
  std::vector<Positions> positions;
  for (const GridFrame& frame : frames) positions.push_back(positions_of(frame));
  if (positions.size() < 2 || positions.front().empty()) return {};
  std::vector<PeerResult> results{measure_peer(raw_peer(), positions)};
#ifdef VAT_HAS_ZSTD
  results.push_back(measure_peer(zstd_peer(), positions));
  results.push_back(measure_peer(zstd_delta_peer(), positions));
#else
  results.push_back(missing("16 bits, zstd"));
  results.push_back(missing("differences, zstd"));
#endif
#ifdef VAT_HAS_DRACO
  results.push_back(measure_peer(draco_peer(), positions));
#else
  results.push_back(missing("Draco"));
#endif
#ifdef VAT_HAS_MESHOPTIMIZER
  results.push_back(measure_peer(meshoptimizer_peer(), positions));
#else
  results.push_back(missing("meshoptimizer"));
#endif
  return results;
}

}  // namespace vat::bench
