#include "server/cli/serve_access.h"

#include <spdlog/spdlog.h>

#include <boost/asio/ip/address.hpp>
#include <cstdlib>
#include <fstream>
#include <optional>

#include "server/access/token.h"

namespace vat {
namespace {

constexpr std::size_t kMinTokenBytes = 16;
constexpr const char* kVariable = "VAT_ADMIN_TOKEN";

bool is_loopback(const std::string& host) {
  return boost::asio::ip::make_address(host).is_loopback();
}

/// The admin's token as it was given; nothing if it was not.
Result<std::optional<std::string>> given_token(const std::string& file) {
  if (file.empty()) {
    const char* const value = std::getenv(kVariable);
    return value == nullptr ? std::nullopt : std::optional<std::string>(value);
  }
  std::ifstream stream(file);
  std::string line;
  if (!std::getline(stream, line)) {
    return Error{"unreadable_file", "", "cannot read a token from " + file};
  }
  return std::optional(line);
}

}  // namespace

Result<ServeAccess> serve_access(const ServeSettings& settings) {
  const bool is_open =
      settings.access == "auto" ? is_loopback(settings.host) : settings.access == "open";
  ServeAccess access;
  access.settings.mode = is_open ? AccessMode::open : AccessMode::token;
  const Result<std::optional<std::string>> given = given_token(settings.admin_token_file);
  if (!given) return given.errors();
  if (given.value() && given.value()->size() < kMinTokenBytes) {
    return Error{
        "out_of_range", "",
        "the admin's token must have at least " + std::to_string(kMinTokenBytes) + " bytes"};
  }
  if (!given.value() && !is_open) access.made_token = make_token();
  if (given.value()) access.settings.admin = hash_of_token(*given.value());
  if (!access.made_token.empty()) access.settings.admin = hash_of_token(access.made_token);
  return access;
}

void tell_access(const ServeSettings& settings, const ServeAccess& access, const std::string& url) {
  if (access.settings.mode == AccessMode::open) {
    if (is_loopback(settings.host)) return;
    spdlog::warn("OPEN ACCESS on {}: every client that reaches this address can control the server",
                 settings.host);
    return;
  }
  if (access.made_token.empty()) return;
  // The only token that is ever logged, and in a fragment, which no request carries.
  spdlog::warn("the admin enters at {}#ticket={}", url, access.made_token);
}

}  // namespace vat
