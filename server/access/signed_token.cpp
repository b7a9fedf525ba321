#include "server/access/signed_token.h"

#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/hmac.h>

#include <algorithm>
#include <array>
#include <span>
#include <stdexcept>

#include "protocol/json/json_reader.h"
#include "server/access/token.h"
#include "server/support/base64.h"

namespace vat {
namespace {

constexpr char kPoint = '.';

/// base64url without padding (RFC 4648, section 5).
std::string to_base64url(std::span<const std::uint8_t> bytes) {
  std::string text = to_base64(bytes);
  text.erase(std::ranges::find(text, '='), text.end());
  std::ranges::replace(text, '+', '-');
  std::ranges::replace(text, '/', '_');
  return text;
}

std::optional<std::string> from_base64url(std::string_view url_text) {
  std::string text(url_text);
  std::ranges::replace(text, '-', '+');
  std::ranges::replace(text, '_', '/');
  text.append((4 - text.size() % 4) % 4, '=');
  const auto bytes = from_base64(text);
  if (!bytes) return {};
  return std::string(bytes->begin(), bytes->end());
}

std::span<const std::uint8_t> bytes_in(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

template <class Enum>
std::optional<Enum> find_named(const std::string& name) {
  const auto found = std::ranges::find(kNamesOf<Enum>, name);
  if (found == kNamesOf<Enum>.end()) return {};
  return static_cast<Enum>(found - kNamesOf<Enum>.begin());
}

std::optional<TokenClaims> read_claims(const std::string& text) {
  const Json json = Json::parse(text, nullptr, false);
  try {
    const auto kind = find_named<TokenClaims::Kind>(json.at("kind"));
    const auto role = find_named<Role>(json.at("role"));
    if (!kind || !role) return {};
    return TokenClaims{*kind, *role, json.at("session"), json.at("ends")};
  } catch (const Json::exception&) {
    return {};  // signed by another version of this program
  }
}

}  // namespace

std::string TokenSigner::signature_of(std::string_view payload) const {
  std::array<std::uint8_t, EVP_MAX_MD_SIZE> signature{};
  unsigned size = 0;
  const auto bytes = bytes_in(payload);
  const auto* made = HMAC(EVP_sha256(), key_.data(), static_cast<int>(key_.size()), bytes.data(),
                          bytes.size(), signature.data(), &size);
  if (made == nullptr) throw std::runtime_error("a token cannot be signed");
  return to_base64url(std::span(signature).first(size));
}

std::string TokenSigner::sign(const TokenClaims& claims) const {
  const Json json{{"id", make_token()},
                  {"kind", to_string(claims.kind)},
                  {"role", to_string(claims.role)},
                  {"session", claims.session},
                  {"ends", claims.ends}};
  const std::string payload = to_base64url(bytes_in(json.dump()));
  return payload + kPoint + signature_of(payload);
}

std::optional<TokenClaims> TokenSigner::verify(std::string_view token, double now) const {
  const std::size_t point = token.find(kPoint);
  if (point == std::string_view::npos) return {};
  const std::string_view payload = token.substr(0, point);
  const std::string_view given = token.substr(point + 1);
  const std::string right = signature_of(payload);
  const bool is_right =
      given.size() == right.size() && CRYPTO_memcmp(given.data(), right.data(), right.size()) == 0;
  if (!is_right) return {};
  const auto text = from_base64url(payload);
  if (!text) return {};
  auto claims = read_claims(*text);
  if (claims && claims->ends > 0 && static_cast<double>(claims->ends) <= now) return {};
  return claims;
}

bool TokenSigner::has_signature(std::string_view token) {
  return token.find(kPoint) != std::string_view::npos;
}

}  // namespace vat
