#include "server/support/base64.h"

#include <openssl/evp.h>

#include <limits>

namespace vat {
namespace {

constexpr auto kMaxDecodedBytes = static_cast<std::size_t>(std::numeric_limits<int>::max());

std::uint8_t* bytes_of(std::string& text) {
  return reinterpret_cast<std::uint8_t*>(text.data());
}

}  // namespace

std::string to_base64(std::span<const std::uint8_t> bytes) {
  std::string text((bytes.size() + 2) / 3 * 4 + 1, '\0');  // EVP ends it by a zero
  EVP_EncodeBlock(bytes_of(text), bytes.data(), static_cast<int>(bytes.size()));
  text.pop_back();
  return text;
}

std::optional<std::vector<std::uint8_t>> from_base64(std::string_view text) {
  if (text.size() % 4 != 0 || text.size() > kMaxDecodedBytes) return {};
  std::vector<std::uint8_t> bytes(text.size() / 4 * 3);
  const auto* characters = reinterpret_cast<const std::uint8_t*>(text.data());
  const int size = EVP_DecodeBlock(bytes.data(), characters, static_cast<int>(text.size()));
  if (size != static_cast<int>(bytes.size())) return {};
  // Padding is decoded to zeros.
  if (text.ends_with("==")) bytes.pop_back();
  if (text.ends_with('=')) bytes.pop_back();
  // White space at the ends is passed over by EVP, and other bits than zero before the padding.
  if (to_base64(bytes) != text) return {};
  return bytes;
}

}  // namespace vat
