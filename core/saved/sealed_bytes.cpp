#include "core/saved/sealed_bytes.h"

#include <algorithm>
#include <string>

#include "core/support/byte_io.h"
#include "core/support/check.h"
#include "core/support/hash.h"

namespace vat {
namespace {

constexpr std::size_t kLengthAt = 12;
constexpr std::size_t kChecksumAt = 20;

/// Each word enters by a bijection, so that a change of one word changes the checksum.
std::uint64_t checksum_of(std::span<const std::uint8_t> bytes) {
  StateHash hash;
  ByteReader reader(bytes);
  while (reader.left() >= sizeof(std::uint64_t)) hash.add(reader.get<std::uint64_t>());
  while (reader.left() > 0) hash.add(std::uint64_t{reader.get<std::uint8_t>()});
  return hash.value();
}

}  // namespace

std::vector<std::uint8_t> begin_sealed(const Seal& seal) {
  VAT_CHECK(seal.magic.size() == kSealVersionAt);
  std::vector<std::uint8_t> bytes(seal.magic.begin(), seal.magic.end());
  bytes.resize(kSealSize);
  store(bytes, kSealVersionAt, seal.version);
  return bytes;
}

void close_seal(std::vector<std::uint8_t>& bytes) {
  VAT_CHECK(bytes.size() >= kSealSize);
  const auto content = std::span<const std::uint8_t>(bytes).subspan(kSealSize);
  store<std::uint64_t>(bytes, kLengthAt, content.size());
  store(bytes, kChecksumAt, checksum_of(content));
}

Result<std::span<const std::uint8_t>> open_sealed(const Seal& seal,
                                                  std::span<const std::uint8_t> bytes) {
  const std::string name(seal.name);
  if (bytes.size() < kSealSize || !std::ranges::equal(bytes.first(seal.magic.size()), seal.magic)) {
    return Error{"other_format", "", "these are not the bytes of " + name};
  }
  ByteReader reader(bytes.subspan(kSealVersionAt));
  const auto version = reader.get<std::uint32_t>();
  if (version < seal.oldest_version || version > seal.version) {
    return Error{"other_version", "",
                 name + " is in version " + std::to_string(version) +
                     " of its format, and this program reads version " +
                     std::to_string(seal.version)};
  }
  const auto length = reader.get<std::uint64_t>();
  const auto checksum = reader.get<std::uint64_t>();
  const auto content = bytes.subspan(kSealSize);
  if (length != content.size()) {
    return Error{"wrong_length", "",
                 name + " has " + std::to_string(content.size()) +
                     " bytes after its header, which states " + std::to_string(length)};
  }
  if (checksum != checksum_of(content)) {
    return Error{"damaged", "", name + " does not match its checksum"};
  }
  return content;
}

std::uint32_t sealed_version(std::span<const std::uint8_t> bytes) {
  VAT_CHECK(bytes.size() >= kSealSize);
  return ByteReader(bytes.subspan(kSealVersionAt)).get<std::uint32_t>();
}

}  // namespace vat
