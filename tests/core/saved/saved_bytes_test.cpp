#include <gtest/gtest.h>

#include "core/saved/sealed_bytes.h"
#include "core/support/byte_io.h"
#include "tests/core/support/resting_scenes.h"
#include "tests/support/errors.h"
#include "tests/support/shaken_vat.h"

// The reader of saved simulations rejects every input that is not a saved snapshot, and names the
// error.

namespace vat::test::saved_bytes_test {
namespace {

std::vector<std::uint8_t> make_bytes() {
  Simulation simulation = make_advanced(make_shaken_vat(IntegratorId::velocity_verlet), 10);
  EXPECT_TRUE(simulation.grab_start(7, simulation.bodies()[1].id, 5, {0.1, 0.1, 0.4}).ok());
  EXPECT_TRUE(simulation.apply_force(simulation.bodies()[2].id, {5, 0, -3}, 0.04).ok());
  simulation.advance(1);
  return simulation.snapshot().to_bytes();
}

std::string code_of(std::span<const std::uint8_t> bytes) {
  const Result<Simulation> loaded = Simulation::load(bytes);
  return loaded ? "" : loaded.errors()[0].code;
}

TEST(SavedBytes, OfWhichSomeAreMissingAreRefused) {
  const std::vector<std::uint8_t> bytes = make_bytes();
  ASSERT_EQ(code_of(bytes), "");
  for (std::size_t length = 0; length < bytes.size(); length += 1 + length / 100) {
    const std::string expected = length < kSealSize ? "other_format" : "wrong_length";
    ASSERT_EQ(code_of(std::span(bytes).first(length)), expected) << length;
  }
}

TEST(SavedBytes, WithMoreAfterThemAreRefused) {
  std::vector<std::uint8_t> bytes = make_bytes();
  bytes.push_back(0);
  EXPECT_EQ(code_of(bytes), "wrong_length");
  close_seal(bytes);
  EXPECT_EQ(code_of(bytes), "bad_value");
}

TEST(SavedBytes, OfAnotherVersionAreRefused) {
  std::vector<std::uint8_t> bytes = make_bytes();
  for (const std::uint32_t version : {0U, 5U}) {
    store<std::uint32_t>(bytes, kSealVersionAt, version);
    EXPECT_EQ(code_of(bytes), "other_version");
  }
}

// Version 3 has no sub-steps of bodies, and version 2 no motions and axles. Version 1 also has no
// motion of the vat at its end unless a user moved it, and no appearances.
TEST(SavedBytes, OfEarlierVersionsAreRead) {
  const Simulation simulation = make_simulation(make_shaken_vat(IntegratorId::velocity_verlet));
  std::vector<std::uint8_t> bytes = simulation.snapshot().to_bytes();
  const auto cut = [&](std::size_t size, std::uint32_t version) {
    bytes.resize(bytes.size() - size);
    store<std::uint32_t>(bytes, kSealVersionAt, version);
    close_seal(bytes);
    const Result<Simulation> loaded = Simulation::load(bytes);
    ASSERT_TRUE(loaded.ok()) << loaded.errors()[0].message;
    EXPECT_EQ(loaded.value().state_hash(), simulation.state_hash());
    store<std::uint32_t>(bytes, kSealVersionAt, version + 1);
    EXPECT_EQ(code_of(bytes), "bad_value");
  };
  // Each absent member is one byte, and each list begins with its length.
  const std::size_t sub_steps = sizeof(std::uint32_t);
  cut(sizeof(std::uint32_t) + sub_steps * simulation.scene().bodies.size(), 3);
  const std::size_t guidance = 2;
  cut(sizeof(std::uint32_t) + guidance * simulation.scene().bodies.size(), 2);
  const std::size_t appearance = 6;
  cut(1 + sizeof(std::uint32_t) + appearance * simulation.scene().materials.size(), 1);
}

TEST(SavedBytes, OfAnotherInstructionSetAreRefused) {
  const Simulation simulation =
      Simulation::create(make_shaken_vat(IntegratorId::heun), nullptr, InstructionSet::baseline)
          .value();
  std::vector<std::uint8_t> bytes = simulation.snapshot().to_bytes();
  ASSERT_TRUE(Simulation::load(bytes, nullptr, InstructionSet::baseline).ok());
  EXPECT_EQ(Simulation::load(bytes).value().instruction_set(), InstructionSet::baseline);
  EXPECT_EQ(errors_of(Simulation::load(bytes, nullptr, InstructionSet::avx2)),
            "other_instruction_set /instruction_set");
  bytes[kSealSize] = 3;
  close_seal(bytes);
  EXPECT_EQ(code_of(bytes), "bad_value");
}

TEST(SavedBytes, DamagedAnywhereAreRefused) {
  std::vector<std::uint8_t> bytes = make_bytes();
  for (std::size_t at = kSealSize; at < bytes.size(); at += 1 + at / 200) {
    for (const unsigned bit : {1u, 128u}) {
      bytes[at] = static_cast<std::uint8_t>(bytes[at] ^ bit);
      ASSERT_EQ(code_of(bytes), "damaged") << at;
      bytes[at] = static_cast<std::uint8_t>(bytes[at] ^ bit);
    }
  }
  EXPECT_EQ(code_of(bytes), "");
}

/// Returns the error code of modified bytes with a corrected checksum. If the reader accepts them,
/// the simulation must be able to continue.
std::string code_of_forged(std::vector<std::uint8_t> bytes) {
  close_seal(bytes);
  Result<Simulation> loaded = Simulation::load(bytes);
  if (!loaded) return loaded.errors()[0].code;
  loaded.value().advance(2);
  return "";
}

// The state hash does not cover texts, reports and the scene's numbers.
TEST(SavedBytes, ForgedAnywhereAreRefusedOrGoneOnWith) {
  const std::vector<std::uint8_t> bytes = make_bytes();
  for (std::size_t at = kSealSize; at < bytes.size(); at += 1 + at / 200) {
    for (const unsigned value : {0x00u, 0x7fu, 0xffu}) {
      std::vector<std::uint8_t> forged = bytes;
      forged[at] = static_cast<std::uint8_t>(value);
      const std::string code = code_of_forged(std::move(forged));
      ASSERT_TRUE(code.empty() || code == "bad_value") << at << ' ' << code;
    }
  }
}

TEST(SavedBytes, WithAnotherPlaceAreNotTheStateOfTheirHash) {
  Simulation simulation = make_advanced(make_shaken_vat(IntegratorId::velocity_verlet), 10);
  std::vector<std::uint8_t> bytes = simulation.snapshot().to_bytes();
  std::vector<std::uint8_t> place;
  ByteWriter writer(place);
  for (int axis = 0; axis < 3; ++axis) writer.put(simulation.bodies()[0].positions[3][axis]);
  const auto found = std::search(bytes.begin(), bytes.end(), place.begin(), place.end());
  ASSERT_NE(found, bytes.end());
  *found ^= 1;
  close_seal(bytes);
  EXPECT_EQ(errors_of(Simulation::load(bytes)), "bad_value /hash");
}

TEST(SavedBytes, CutAndSignedAnewAreRefused) {
  const std::vector<std::uint8_t> bytes = make_bytes();
  for (std::size_t length = kSealSize; length < bytes.size(); length += 1 + length / 100) {
    std::vector<std::uint8_t> cut(bytes.begin(), bytes.begin() + static_cast<long>(length));
    ASSERT_EQ(code_of_forged(std::move(cut)), "bad_value") << length;
  }
}

}  // namespace
}  // namespace vat::test::saved_bytes_test
