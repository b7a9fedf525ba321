#include "server/cli/serve/serve_access.h"

#include <boost/asio/ip/address.hpp>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <optional>

#include "server/access/signed_token.h"
#include "server/access/token.h"
#include "server/support/log.h"

namespace vat {
namespace {

constexpr std::size_t kMinTokenBytes = 16;
constexpr const char* kVariable = "VAT_ADMIN_TOKEN";
constexpr const char* kKeyVariable = "VAT_CLUSTER_KEY";

bool is_loopback(const std::string& host) {
  return boost::asio::ip::make_address(host).is_loopback();
}

/// Returns whether only clients of this machine can reach the server. A proxy on this machine can
/// have clients elsewhere.
bool is_for_this_machine(const ServeSettings& settings) {
  return is_loopback(settings.host) && settings.public_name.empty() &&
         settings.trusted_proxy.empty();
}

/// A text that the server does not print.
struct Secret {
  const char* name;
  std::size_t least_bytes;
};

/// Returns the first line of a file.
Result<std::string> read_secret(const std::string& file, const Secret& secret) {
  std::ifstream stream(file);
  std::string line;
  if (!std::getline(stream, line)) {
    return Error{"unreadable_file", "",
                 "cannot read a " + std::string(secret.name) + " from " + file};
  }
  return line;
}

/// Returns the secret in a file, or in the variable if there is no file. Returns nothing if there
/// is neither.
Result<std::optional<std::string>> given_secret(const std::string& file, const char* variable,
                                                const Secret& secret) {
  const char* const value = variable == nullptr ? nullptr : std::getenv(variable);
  if (file.empty() && value == nullptr) return std::optional<std::string>();
  const Result<std::string> text =
      file.empty() ? Result<std::string>(value) : read_secret(file, secret);
  if (!text) return text.errors();
  if (text.value().size() < secret.least_bytes) {
    return Error{"out_of_range", "",
                 "the " + std::string(secret.name) + " of " + (file.empty() ? variable : file) +
                     " must have at least " + std::to_string(secret.least_bytes) + " bytes"};
  }
  return std::optional(text.value());
}

/// Returns the hash of a given token.
Result<std::optional<TokenHash>> given_hash(const std::string& file, const char* variable) {
  const auto token = given_secret(file, variable, {"token", kMinTokenBytes});
  if (!token) return token.errors();
  if (!token.value()) return std::optional<TokenHash>();
  return std::optional(hash_of_token(*token.value()));
}

/// Returns the key of the cluster; empty: there is none.
Result<std::string> given_cluster_key(const ClusterSettings& cluster, bool is_open) {
  if (!cluster.is_used()) return std::string();
  const auto key = given_secret(cluster.key_file, kKeyVariable, {"key", TokenSigner::kMinKeyBytes});
  if (!key) return key.errors();
  if (!key.value() && !is_open) {
    return Error{"missing", "",
                 "a cluster with access by token needs a key: the setting cluster_key_file or the "
                 "variable VAT_CLUSTER_KEY"};
  }
  return key.value().value_or("");
}

}  // namespace

Result<ServeAccess> serve_access(const ServeSettings& settings) {
  const bool is_open =
      settings.access == "auto" ? is_for_this_machine(settings) : settings.access == "open";
  ServeAccess access;
  access.settings.mode = is_open ? AccessMode::open : AccessMode::token;
  const auto admin = given_hash(settings.admin_token_file, kVariable);
  if (!admin) return admin.errors();
  const auto metrics = given_hash(settings.metrics_token_file, nullptr);
  if (!metrics) return metrics.errors();
  const auto key = given_cluster_key(settings.cluster, is_open);
  if (!key) return key.errors();
  access.cluster_key = key.value();
  access.settings.admin = admin.value();
  access.settings.metrics = metrics.value();
  if (!admin.value() && !is_open) {
    access.made_token = make_token();
    access.settings.admin = hash_of_token(access.made_token);
  }
  return access;
}

void tell_access(const ServeSettings& settings, const ServeAccess& access, const std::string& url) {
  if (access.settings.mode == AccessMode::open) {
    if (is_for_this_machine(settings)) return;
    log_warning("OPEN ACCESS on {}: every client that reaches this address can control the server",
                settings.host);
    return;
  }
  if (access.made_token.empty()) return;
  // Not logged, because logs are collected. Requests do not contain the fragment.
  std::cout << "the admin enters at " << url << "#ticket=" << access.made_token << std::endl;
}

}  // namespace vat
