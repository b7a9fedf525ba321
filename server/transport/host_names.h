#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace vat {

enum class HostKind {
  foreign,     ///< not a name of this server
  local,       ///< "localhost" or a numeric address
  public_name  ///< a name of TransportSettings::public_names
};

/// Returns the kind of a Host header, such as "localhost:8080". A page of another site can make its
/// own name resolve to this server's address (DNS rebinding). Its requests then contain this
/// foreign name. They cannot contain a numeric address.
HostKind kind_of_host(std::string_view host, const std::vector<std::string>& public_names);

/// Returns whether the text is a host name in ASCII with an optional port from 1 to 65535, such as
/// "example.org" or "example.org:8443".
bool is_host_name(std::string_view text);

}  // namespace vat
