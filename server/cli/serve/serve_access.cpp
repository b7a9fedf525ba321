#include "server/cli/serve/serve_access.h"

#include <boost/asio/ip/address.hpp>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <optional>

#include "server/access/token.h"
#include "server/support/log.h"

namespace vat {
namespace {

constexpr std::size_t kMinTokenBytes = 16;
constexpr const char* kVariable = "VAT_ADMIN_TOKEN";

bool is_loopback(const std::string& host) {
  return boost::asio::ip::make_address(host).is_loopback();
}

/// Returns whether only clients of this machine can reach the server. A proxy on this machine can
/// have clients elsewhere.
bool is_for_this_machine(const ServeSettings& settings) {
  return is_loopback(settings.host) && settings.public_name.empty() &&
         settings.trusted_proxy.empty();
}

/// Returns the first line of a file, which must be long enough for a token.
Result<std::string> read_token(const std::string& file) {
  std::ifstream stream(file);
  std::string line;
  if (!std::getline(stream, line)) {
    return Error{"unreadable_file", "", "cannot read a token from " + file};
  }
  return line;
}

Status check_length(const std::string& token, const std::string& source) {
  if (token.size() >= kMinTokenBytes) return {};
  return Error{"out_of_range", "",
               "the token of " + source + " must have at least " + std::to_string(kMinTokenBytes) +
                   " bytes"};
}

/// Returns the hash of the token in a file, or in the variable if there is no file. Returns no hash
/// if there is neither.
Result<std::optional<TokenHash>> given_hash(const std::string& file, const char* variable) {
  const char* const value = variable == nullptr ? nullptr : std::getenv(variable);
  if (file.empty() && value == nullptr) return std::optional<TokenHash>();
  const Result<std::string> token = file.empty() ? Result<std::string>(value) : read_token(file);
  if (!token) return token.errors();
  const Status is_long = check_length(token.value(), file.empty() ? variable : file);
  if (!is_long) return is_long.errors();
  return std::optional(hash_of_token(token.value()));
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
