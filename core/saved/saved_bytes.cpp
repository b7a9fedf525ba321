#include "core/saved/saved_bytes.h"

#include <algorithm>
#include <string>

#include "core/support/byte_io.h"
#include "core/support/check.h"
#include "core/support/hash.h"

namespace vat {
namespace {

constexpr std::size_t kLengthAt = kSavedHeaderSize - 2 * sizeof(std::uint64_t);
constexpr std::size_t kChecksumAt = kSavedHeaderSize - sizeof(std::uint64_t);

/// Differs wherever one word does: each word is mixed in by a bijection.
std::uint64_t checksum_of(std::span<const std::uint8_t> bytes) {
  StateHash hash;
  ByteReader reader(bytes);
  while (reader.left() >= sizeof(std::uint64_t)) hash.add(reader.get<std::uint64_t>());
  while (reader.left() > 0) hash.add(std::uint64_t{reader.get<std::uint8_t>()});
  return hash.value();
}

}  // namespace

std::vector<std::uint8_t> begin_saved(InstructionSet instructions) {
  std::vector<std::uint8_t> bytes(kSavedMagic.begin(), kSavedMagic.end());
  ByteWriter writer(bytes);
  writer.put(kSavedVersion);
  writer.put(static_cast<std::uint8_t>(instructions));
  bytes.resize(kSavedHeaderSize);
  return bytes;
}

void finish_saved(std::vector<std::uint8_t>& bytes) {
  const auto content = std::span<const std::uint8_t>(bytes).subspan(kSavedHeaderSize);
  store<std::uint64_t>(bytes, kLengthAt, content.size());
  store(bytes, kChecksumAt, checksum_of(content));
}

Result<SavedContent> open_saved(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kSavedHeaderSize || !std::ranges::equal(bytes.first(8), kSavedMagic)) {
    return Error{"not_saved", "", "these are not the bytes of a saved simulation"};
  }
  ByteReader reader(bytes.subspan(kSavedMagic.size()));
  const auto version = reader.get<std::uint32_t>();
  if (version != kSavedVersion) {
    return Error{"other_version", "",
                 "the simulation was saved in version " + std::to_string(version) +
                     " of the format; this program reads version " + std::to_string(kSavedVersion)};
  }
  const auto instructions = reader.get<std::uint8_t>();
  const auto length = reader.get<std::uint64_t>();
  const auto checksum = reader.get<std::uint64_t>();
  const auto content = bytes.subspan(kSavedHeaderSize);
  if (length != content.size()) {
    return Error{"wrong_length", "",
                 "the saved simulation has " + std::to_string(content.size()) +
                     " bytes behind its header, which tells of " + std::to_string(length)};
  }
  if (checksum != checksum_of(content)) {
    return Error{"damaged", "", "the saved simulation's checksum is not that of its bytes"};
  }
  if (instructions > static_cast<std::uint8_t>(InstructionSet::avx512)) {
    return Error{"bad_value", "/instruction_set", "must be one that this program knows"};
  }
  return SavedContent{static_cast<InstructionSet>(instructions), content};
}

}  // namespace vat
