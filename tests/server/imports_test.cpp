// Recordings that clients bring in parts.

#include "server/replay/imports.h"

#include <gtest/gtest.h>

#include "server/session/base64.h"

namespace vat::test::imports_test {
namespace {

const Imports::Clock::time_point kStart{};

Imports::Part first_part(std::size_t bytes) {
  return {{}, 100, 0, std::vector<std::uint8_t>(bytes)};
}

TEST(Imports, AreSoManyAtMost) {
  Imports imports;
  for (std::size_t n = 0; n < Imports::kMostFiles; ++n) {
    EXPECT_TRUE(std::holds_alternative<Imports::Progress>(imports.add(1, first_part(3), kStart)));
  }
  const auto refused = imports.add(1, first_part(3), kStart);
  ASSERT_TRUE(std::holds_alternative<RpcError>(refused));
  EXPECT_EQ(std::get<RpcError>(refused).data.at("limit"), "imports");
  const auto later = imports.add(1, first_part(3), kStart + 2 * Imports::kPatience);
  EXPECT_TRUE(std::holds_alternative<Imports::Progress>(later));
}

TEST(Imports, AreForgottenInTime) {
  Imports imports;
  imports.add(1, first_part(3), kStart);
  imports.add(1, first_part(4), kStart + std::chrono::seconds(1));
  EXPECT_EQ(imports.forget_old(kStart + Imports::kPatience), 7U);
  EXPECT_EQ(imports.forget_old(kStart + Imports::kPatience + std::chrono::milliseconds(1)), 4U);
}

TEST(Imports, HaveSoManyBytesAtMost) {
  Imports imports(50);
  const auto begun = imports.add(1, first_part(30), kStart);
  const std::string name = std::get<Imports::Progress>(begun).name;
  const Imports::Part next{name, 100, 30, std::vector<std::uint8_t>(20)};
  EXPECT_TRUE(std::holds_alternative<Imports::Progress>(imports.add(1, next, kStart)));
  const auto refused = imports.add(1, first_part(1), kStart);
  ASSERT_TRUE(std::holds_alternative<RpcError>(refused));
  EXPECT_EQ(std::get<RpcError>(refused).data.at("limit"), "import_bytes");
}

TEST(Base64, IsReadWholeOrNotAtAll) {
  using Bytes = std::vector<std::uint8_t>;
  EXPECT_EQ(from_base64(""), Bytes());
  EXPECT_EQ(from_base64("Zg=="), Bytes{'f'});
  EXPECT_EQ(from_base64("Zm8="), (Bytes{'f', 'o'}));
  EXPECT_EQ(from_base64("Zm9v"), (Bytes{'f', 'o', 'o'}));
  for (const char* bad : {"Z", "Zg=", "Z===", "Zg==Zg==", "Z g=", "Zm9v\n", "Zm9*", "===="}) {
    EXPECT_FALSE(from_base64(bad).has_value()) << bad;
  }
}

}  // namespace
}  // namespace vat::test::imports_test
