// The client's address behind trusted proxies.

#include "server/transport/client_address.h"

#include <gtest/gtest.h>

namespace vat::test::client_address_test {
namespace {

const TrustedProxies kProxies({"10.0.0.0/8", "192.0.2.1", "fd00::/8"});

std::string client(const char* peer, const char* forwarded, const char* x_forwarded_for) {
  const auto address = boost::asio::ip::make_address(peer);
  return kProxies.client_of(address, forwarded, x_forwarded_for).to_string();
}

TEST(ClientAddress, HeadersOfOtherPeersDoNotCount) {
  EXPECT_EQ(client("192.0.2.2", "for=198.51.100.1", "198.51.100.1"), "192.0.2.2");
  EXPECT_EQ(client("11.0.0.0", "", "198.51.100.1"), "11.0.0.0");
  EXPECT_EQ(client("fe00::1", "", "198.51.100.1"), "fe00::1");
  EXPECT_EQ(client("10.0.0.1", "", ""), "10.0.0.1");
}

TEST(ClientAddress, IsTheLastThatIsNotTrusted) {
  struct Case {
    const char* list;
    const char* client;
  };
  for (const Case& one :
       {Case{"198.51.100.1", "198.51.100.1"}, Case{"198.51.100.1:4711", "198.51.100.1"},
        Case{"1.1.1.1, 198.51.100.1", "198.51.100.1"},
        Case{"1.1.1.1,198.51.100.1 , 10.9.9.9", "198.51.100.1"},
        Case{"198.51.100.1, 192.0.2.1, fd12::1", "198.51.100.1"},
        Case{"10.0.0.2, 10.0.0.3", "10.0.0.2"}, Case{"2001:db8::1", "2001:db8::1"},
        Case{"[2001:db8::1]:80", "2001:db8::1"}, Case{"::ffff:198.51.100.1", "198.51.100.1"},
        Case{"rubbish, 198.51.100.1", "198.51.100.1"}}) {
    EXPECT_EQ(client("10.0.0.1", "", one.list), one.client) << one.list;
  }
}

TEST(ClientAddress, IsAParameterOfForwarded) {
  struct Case {
    const char* header;
    const char* client;
  };
  for (const Case& one :
       {Case{"for=198.51.100.1", "198.51.100.1"}, Case{"For=\"198.51.100.1:80\"", "198.51.100.1"},
        Case{"proto=https;for=198.51.100.1;by=10.0.0.1", "198.51.100.1"},
        Case{"for=\"[2001:db8::1]:4711\"", "2001:db8::1"}, Case{"for=\"\\1.1.1.1\"", "1.1.1.1"},
        Case{"for=1.1.1.1;host=\"a,b;for=2.2.2.2\", for=198.51.100.1, for=10.2.2.2",
             "198.51.100.1"},
        Case{"for=unknown, for=198.51.100.1", "198.51.100.1"}}) {
    EXPECT_EQ(client("fd00::1", one.header, ""), one.client) << one.header;
  }
}

TEST(ClientAddress, OfMalformedHeadersIsThePeer) {
  for (const char* list : {"unknown", "_hidden", "198.51.100.1,", "198.51.100", "1.1.1.1 2.2.2.2",
                           "[::1", "[::1]x", "1.1.1.1/8", ","}) {
    EXPECT_EQ(client("10.0.0.1", "", list), "10.0.0.1") << list;
  }
  for (const char* header :
       {"for", "for=", "=1.1.1.1", "for=\"1.1.1.1", "for=\"1.1.1.1\\", "for=unknown", "for=_hidden",
        "proto=https", "for=1.1.1.1 for=2.2.2.2", "for=1.1.1.1;for=2.2.2.2", "for=1.1.1.1,",
        "for=2001:db8::1", "1.1.1.1", "for=\", for=1.1.1.1"}) {
    EXPECT_EQ(client("10.0.0.1", header, ""), "10.0.0.1") << header;
  }
}

// A client can add the header that its proxy does not write.
TEST(ClientAddress, OfHeadersThatDifferIsThePeer) {
  EXPECT_EQ(client("10.0.0.1", "for=1.1.1.1", "2.2.2.2"), "10.0.0.1");
  EXPECT_EQ(client("10.0.0.1", "for=1.1.1.1", "1.1.1.1"), "1.1.1.1");
  EXPECT_EQ(client("10.0.0.1", "rubbish", "1.1.1.1"), "10.0.0.1");
}

TEST(ClientAddress, NetworksAreComparedByTheirBits) {
  const auto trusts = [](const char* network, const char* address) {
    return TrustedProxies({network}).trust(boost::asio::ip::make_address(address));
  };
  EXPECT_TRUE(trusts("192.0.2.128/25", "192.0.2.255"));
  EXPECT_FALSE(trusts("192.0.2.128/25", "192.0.2.127"));
  EXPECT_TRUE(trusts("192.0.2.7/24", "192.0.2.0")) << "the remaining bits do not count";
  EXPECT_TRUE(trusts("0.0.0.0/0", "203.0.113.9"));
  EXPECT_FALSE(trusts("0.0.0.0/0", "::1"));
  EXPECT_TRUE(trusts("2001:db8::/33", "2001:db8:7fff::1"));
  EXPECT_FALSE(trusts("2001:db8::/33", "2001:db8:8000::1"));
  EXPECT_FALSE(trusts("::1", "::2"));
}

TEST(ClientAddress, NetworksAreChecked) {
  for (const char* good : {"10.0.0.1", "10.0.0.0/0", "10.0.0.0/32", "::1", "fd00::/128"}) {
    EXPECT_TRUE(is_network(good)) << good;
  }
  for (const char* bad : {"", "/", "10.0.0.0/", "10.0.0.0/33", "10.0.0.0/-1", "10.0.0.0/8x",
                          "::/129", "10.0.0/8", "proxy.example", "10.0.0.1:80", "*"}) {
    EXPECT_FALSE(is_network(bad)) << bad;
  }
}

TEST(ClientAddress, ForLimitsIsANetworkOfIpv6) {
  const auto limited = [](const char* address) {
    return address_for_limits(without_mapping(boost::asio::ip::make_address(address)));
  };
  EXPECT_EQ(limited("192.0.2.1"), "192.0.2.1");
  EXPECT_EQ(limited("::ffff:192.0.2.1"), "192.0.2.1");
  EXPECT_EQ(limited("2001:db8:1:2:3:4:5:6"), "2001:db8:1:2::/64");
}

}  // namespace
}  // namespace vat::test::client_address_test
