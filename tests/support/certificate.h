#pragma once

#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/x509v3.h>

#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>

namespace vat::test {

template <class Value>
using Owned = std::unique_ptr<Value, void (*)(Value*)>;

inline void free_key(EVP_PKEY* key) {
  EVP_PKEY_free(key);
}

inline void expect_written(bool is_written) {
  if (!is_written) throw std::runtime_error("no certificate");
}

/// Writes a key and a self-signed certificate that is valid for an hour. `names` are the
/// alternative names in OpenSSL's format. `common_name` is the name of the subject.
inline void write_certificate(const std::string& certificate_file, const std::string& key_file,
                              const std::string& names = "DNS:localhost,IP:127.0.0.1",
                              const std::string& common_name = "a test") {
  const Owned<EVP_PKEY> key(EVP_EC_gen("P-256"), free_key);
  const Owned<X509> certificate(X509_new(), X509_free);
  X509_set_version(certificate.get(), X509_VERSION_3);
  ASN1_INTEGER_set(X509_get_serialNumber(certificate.get()), 1);
  X509_gmtime_adj(X509_getm_notBefore(certificate.get()), 0);
  X509_gmtime_adj(X509_getm_notAfter(certificate.get()), 3600);
  X509_set_pubkey(certificate.get(), key.get());
  X509_NAME* name = X509_get_subject_name(certificate.get());
  X509_NAME_add_entry_by_txt(name, "CN", MBSTRING_ASC,
                             reinterpret_cast<const unsigned char*>(common_name.c_str()), -1, -1,
                             0);
  X509_set_issuer_name(certificate.get(), name);
  const Owned<X509_EXTENSION> alternatives(
      X509V3_EXT_conf_nid(nullptr, nullptr, NID_subject_alt_name, names.c_str()),
      X509_EXTENSION_free);
  expect_written(X509_add_ext(certificate.get(), alternatives.get(), -1) == 1);
  expect_written(X509_sign(certificate.get(), key.get(), EVP_sha256()) != 0);
  const auto close_file = [](std::FILE* file) { std::fclose(file); };
  const Owned<std::FILE> first(std::fopen(certificate_file.c_str(), "w"), close_file);
  expect_written(PEM_write_X509(first.get(), certificate.get()) == 1);
  const Owned<std::FILE> second(std::fopen(key_file.c_str(), "w"), close_file);
  expect_written(
      PEM_write_PrivateKey(second.get(), key.get(), nullptr, nullptr, 0, nullptr, nullptr) == 1);
}

}  // namespace vat::test
