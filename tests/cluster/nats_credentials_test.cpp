#include <gtest/gtest.h>
#include <openssl/evp.h>
#include <openssl/rand.h>

#include <array>
#include <memory>

#include "protocol/json/json_reader.h"
#include "server/nats/bucket.h"
#include "tests/cluster/nats_servers.h"

// Credentials of a NATS user: a token (JWT) that the user's account has signed, and the seed of the
// user's key. Formats: https://github.com/nats-io/nkeys and
// https://docs.nats.io/running-a-nats-service/configuration/securing_nats/auth_intro/jwt.

namespace vat::test::nats_credentials_test {
namespace {

using Bytes = std::basic_string<unsigned char>;

/// Encodes groups of `bits` bits as the letters of `alphabet`, without padding.
std::string encode(const Bytes& bytes, int bits, std::string_view alphabet) {
  std::string text;
  unsigned buffer = 0;
  int count = 0;
  const auto mask = (1U << bits) - 1;
  for (const unsigned char byte : bytes) {
    buffer = buffer << 8 | byte;
    for (count += 8; count >= bits; count -= bits) {
      text += alphabet[buffer >> (count - bits) & mask];
    }
  }
  if (count > 0) text += alphabet[buffer << (bits - count) & mask];
  return text;
}

std::string base32(const Bytes& bytes) {
  return encode(bytes, 5, "ABCDEFGHIJKLMNOPQRSTUVWXYZ234567");
}

std::string base64url(const Bytes& bytes) {
  return encode(bytes, 6, "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_");
}

Bytes to_bytes(const std::string& text) {
  return {text.begin(), text.end()};
}

/// Appends the checksum CRC-16/XMODEM of the bytes.
Bytes with_checksum(Bytes bytes) {
  unsigned sum = 0;
  for (const unsigned char byte : bytes) {
    sum ^= static_cast<unsigned>(byte) << 8;
    for (int bit = 0; bit < 8; ++bit)
      sum = (sum & 0x8000U ? sum << 1 ^ 0x1021U : sum << 1) & 0xffffU;
  }
  bytes += static_cast<unsigned char>(sum & 0xffU);
  bytes += static_cast<unsigned char>(sum >> 8);
  return bytes;
}

/// Kind of a key's owner, encoded in the first letter of the key.
enum class Kind : unsigned char { account = 0, operator_key = 14 << 3, user = 20 << 3 };

/// A new Ed25519 key in the text form of NATS.
class Key {
 public:
  explicit Key(Kind kind) : kind_(static_cast<unsigned char>(kind)) {
    RAND_bytes(seed_.data(), static_cast<int>(seed_.size()));
    key_.reset(EVP_PKEY_new_raw_private_key(EVP_PKEY_ED25519, nullptr, seed_.data(), seed_.size()));
  }

  std::string name() const {
    Bytes bytes(33, kind_);
    std::size_t size = 32;
    EVP_PKEY_get_raw_public_key(key_.get(), &bytes[1], &size);
    return base32(with_checksum(bytes));
  }

  std::string seed() const {
    constexpr unsigned kSeed = 18 << 3;
    Bytes bytes{static_cast<unsigned char>(kSeed | kind_ >> 5),
                static_cast<unsigned char>((kind_ & 31) << 3)};
    bytes.append(seed_.begin(), seed_.end());
    return base32(with_checksum(bytes));
  }

  /// Returns a signed token with the claims `nats` about the key `subject`.
  std::string sign(const std::string& subject, const Json& nats) const {
    const Json header{{"typ", "JWT"}, {"alg", "ed25519-nkey"}};
    const Json claims{{"jti", "a"},     {"iat", 1},    {"iss", name()},
                      {"sub", subject}, {"name", "a"}, {"nats", nats}};
    const std::string text =
        base64url(to_bytes(header.dump())) + "." + base64url(to_bytes(claims.dump()));
    const std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context(EVP_MD_CTX_new(),
                                                                          EVP_MD_CTX_free);
    Bytes signature(64, 0);
    std::size_t size = signature.size();
    const Bytes bytes = to_bytes(text);
    EXPECT_EQ(EVP_DigestSignInit(context.get(), nullptr, nullptr, nullptr, key_.get()), 1);
    EXPECT_EQ(EVP_DigestSign(context.get(), signature.data(), &size, bytes.data(), bytes.size()),
              1);
    return text + "." + base64url(signature);
  }

 private:
  const unsigned char kind_;
  std::array<unsigned char, 32> seed_{};
  std::unique_ptr<EVP_PKEY, decltype(&EVP_PKEY_free)> key_{nullptr, EVP_PKEY_free};
};

Json account_claims(bool has_streams) {
  Json limits{{"subs", -1},    {"data", -1},        {"payload", -1}, {"imports", -1},
              {"exports", -1}, {"wildcards", true}, {"conn", -1},    {"leaf", -1}};
  if (has_streams) {
    limits.update({{"mem_storage", -1}, {"disk_storage", -1}, {"streams", -1}, {"consumer", -1}});
  }
  return {{"limits", limits}, {"type", "account"}, {"version", 2}};
}

/// Returns the text of a credentials file of a new user of the account.
std::string credentials_of(const Key& account) {
  const Key user(Kind::user);
  const Json claims{{"pub", Json::object()}, {"sub", Json::object()}, {"subs", -1},  {"data", -1},
                    {"payload", -1},         {"type", "user"},        {"version", 2}};
  return "-----BEGIN NATS USER JWT-----\n" + account.sign(user.name(), claims) +
         "\n------END NATS USER JWT------\n\n-----BEGIN USER NKEY SEED-----\n" + user.seed() +
         "\n------END USER NKEY SEED------\n";
}

TEST(NatsCredentials, AdmitUsersOfAKnownAccount) {
  const Key owner(Kind::operator_key);
  const Key system(Kind::account);
  const Key known(Kind::account);
  const Key unknown(Kind::account);
  NatsServers servers(
      1, "operator: " + owner.sign(owner.name(), {{"type", "operator"}, {"version", 2}}) +
             "\nsystem_account: " + system.name() + "\nresolver: MEMORY\nresolver_preload: {\n  " +
             system.name() + ": " + owner.sign(system.name(), account_claims(false)) + "\n  " +
             known.name() + ": " + owner.sign(known.name(), account_claims(true)) + "\n}\n");
  TemporaryFolder folder;
  folder.write("known.creds", credentials_of(known));
  folder.write("unknown.creds", credentials_of(unknown));
  const auto connect = [&](const std::string& credentials) {
    NatsConnection connection({servers.urls(), "test", {}, {}, {}, credentials});
    Bucket(connection, "sessions", std::chrono::milliseconds(0)).create("s1", "a");
  };
  EXPECT_THROW(connect(""), NatsError);
  EXPECT_THROW(connect(folder.file("missing.creds")), NatsError);
  EXPECT_THROW(connect(folder.file("unknown.creds")), NatsError);
  EXPECT_NO_THROW(connect(folder.file("known.creds")));
}

}  // namespace
}  // namespace vat::test::nats_credentials_test
