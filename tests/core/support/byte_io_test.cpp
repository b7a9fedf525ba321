#include "core/support/byte_io.h"

#include <gtest/gtest.h>

namespace vat::byte_io_test {
namespace {

TEST(ByteIo, IsLittleEndian) {
  std::vector<std::uint8_t> bytes;
  ByteWriter out(bytes);
  out.put(std::uint8_t{0x01});
  out.put(std::uint16_t{0x2345});
  out.put(std::uint32_t{0x6789abcd});
  out.put(1.0F);
  out.put(-2.0);
  EXPECT_EQ(bytes, (std::vector<std::uint8_t>{0x01, 0x45, 0x23, 0xcd, 0xab, 0x89, 0x67, 0, 0, 0x80,
                                              0x3f, 0, 0, 0, 0, 0, 0, 0, 0xc0}));
  ByteReader in(bytes);
  EXPECT_EQ(in.get<std::uint8_t>(), 0x01);
  EXPECT_EQ(in.get<std::uint16_t>(), 0x2345);
  EXPECT_EQ(in.get<std::uint32_t>(), 0x6789abcdU);
  EXPECT_EQ(in.get<float>(), 1.0F);
  EXPECT_EQ(in.get<double>(), -2.0);
  EXPECT_EQ(in.left(), 0U);
  EXPECT_FALSE(in.ended_early());
}

TEST(ByteIo, AReaderStaysAtTheEnd) {
  const std::vector<std::uint8_t> bytes{1, 2, 3};
  ByteReader in(bytes);
  EXPECT_EQ(in.get<std::uint32_t>(), 0U);
  EXPECT_TRUE(in.ended_early());
  EXPECT_EQ(in.get<std::uint8_t>(), 0U);
  EXPECT_EQ(in.left(), 0U);
}

}  // namespace
}  // namespace vat::byte_io_test
