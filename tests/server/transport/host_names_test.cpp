// The names of the server in the Host header.

#include "server/transport/host_names.h"

#include <gtest/gtest.h>

namespace vat::test::host_names_test {
namespace {

const std::vector<std::string> kNames{"vat.example", "b.example:8443"};

TEST(HostNames, NumericAddressesAndLocalhostAreLocal) {
  for (const char* host : {"localhost", "LocalHost", "localhost:8080", "127.0.0.1", "127.8.9.10:1",
                           "192.0.2.7:65535", "[::1]", "[::1]:8080", "[2001:db8::7]"}) {
    EXPECT_EQ(kind_of_host(host, {}), HostKind::local) << host;
  }
}

TEST(HostNames, PublicNamesAreComparedWithoutCase) {
  for (const char* host : {"vat.example", "VAT.example", "vat.example:1", "b.example:8443"}) {
    EXPECT_EQ(kind_of_host(host, kNames), HostKind::public_name) << host;
  }
}

TEST(HostNames, OtherHostsAreForeign) {
  for (const char* host :
       {"evil.example", "x.vat.example", "vat.example.evil", "vat.exampl", "vat.example.",
        "b.example", "b.example:8444", "b.example:84430", "localhost.evil", "localhost.",
        "127.0.0.1.evil.example", "127.0.0.1.", "127.1", "2130706433", "0x7f.1",
        "localhost, evil.example", "vat.example, evil.example"}) {
    EXPECT_EQ(kind_of_host(host, kNames), HostKind::foreign) << host;
  }
}

TEST(HostNames, MalformedHostsAreForeign) {
  for (const char* host :
       {".", "::1", "[::1", "[::1]8080", "[::1]:", "[]", "[localhost]", "localhost:", "localhost:0",
        "localhost:65536", "localhost:8080:1", "localhost:80x", "vat.example/", "user@vat.example",
        " localhost", "", ":", ":80"}) {
    EXPECT_EQ(kind_of_host(host, kNames), HostKind::foreign) << host;
  }
}

TEST(HostNames, NamesHaveAnOptionalPort) {
  for (const std::string& name :
       {std::string("a"), std::string("vat.example"), std::string("vat-1.example:8443"),
        std::string("xn--bcher-kva.example"), std::string("my_vat:1"), std::string(253, 'a')}) {
    EXPECT_TRUE(is_host_name(name)) << name;
  }
  for (const std::string& text :
       {std::string(), std::string("*"), std::string("*.example"), std::string("a b"),
        std::string("https://a"), std::string("a/"), std::string("a:0"), std::string("a:65536"),
        std::string("a:"), std::string("b\xc3\xbc.example"), std::string("[::1]"),
        std::string(254, 'a')}) {
    EXPECT_FALSE(is_host_name(text)) << text;
  }
}

}  // namespace
}  // namespace vat::test::host_names_test
