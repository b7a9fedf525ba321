// `vat script` over TLS: whom it believes.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/script/server_process.h"
#include "tests/cli/program.h"
#include "tests/support/certificate.h"

namespace vat::test::script_tls_test {
namespace {

using testing::HasSubstr;

/// A server with TLS, and a script that it meets.
class VatScriptTls : public testing::Test {
 protected:
  explicit VatScriptTls(const std::string& names = "DNS:localhost,IP:127.0.0.1") {
    write_certificate(certificate_, folder_.file("key.pem"), names);
    write_certificate(folder_.file("other.pem"), folder_.file("other-key.pem"));
    folder_.write("met.jsonl", "{\"connect\": \"a\"}\n{\"call\": \"session.join\"}\n");
    server_.emplace(VAT_PROGRAM,
                    std::vector<std::string>{"serve", "--port", "0", "--scene", test_scene("pair"),
                                             "--log-level", "error", "--tls-certificate",
                                             certificate_, "--tls-key", folder_.file("key.pem")});
  }
  /// Plays the script at this host, with these options.
  ProgramResult play(const std::string& host, std::vector<std::string> options) const {
    const std::string port = std::to_string(server_->port());
    options.insert(options.begin(), {"script", "--server", host + ':' + port});
    options.push_back(folder_.file("met.jsonl"));
    return run_vat(options);
  }

  TemporaryFolder folder_;
  std::string certificate_ = folder_.file("certificate.pem");
  std::optional<script::ServerProcess> server_;
};

class VatScriptTlsOfAnother : public VatScriptTls {
 protected:
  VatScriptTlsOfAnother() : VatScriptTls("DNS:example.org,IP:192.0.2.1") {}
};

TEST_F(VatScriptTls, PlaysWhereTheCertificateIsTrusted) {
  EXPECT_TRUE(server_->is_secure());
  for (const char* host : {"wss://localhost", "wss://127.0.0.1"}) {
    const ProgramResult result = play(host, {"--ca", certificate_});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.out, HasSubstr("met.jsonl: 2 lines, all met\n"));
  }
}

TEST_F(VatScriptTls, ACertificateThatNobodyVouchesForIsRefused) {
  for (const std::vector<std::string>& options :
       {std::vector<std::string>{}, {"--ca", folder_.file("other.pem")}}) {
    const ProgramResult result = play("wss://localhost", options);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.err, HasSubstr("met.jsonl:1: the certificate of localhost:"));
    EXPECT_THAT(result.err, HasSubstr("--ca FILE"));
  }
}

TEST_F(VatScriptTlsOfAnother, ACertificateForAnotherServerIsRefused) {
  const ProgramResult name = play("wss://localhost", {"--ca", certificate_});
  EXPECT_EQ(name.exit_code, 1);
  EXPECT_THAT(name.err, HasSubstr("is not trusted: hostname mismatch"));
  const ProgramResult address = play("wss://127.0.0.1", {"--ca", certificate_});
  EXPECT_EQ(address.exit_code, 1);
  EXPECT_THAT(address.err, HasSubstr("is not trusted: IP address mismatch"));
}

TEST_F(VatScriptTlsOfAnother, InsecureBelievesWhoeverAnswers) {
  const ProgramResult result = play("wss://localhost", {"--insecure"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
}

TEST_F(VatScriptTls, TheOtherSchemeIsNamed) {
  const ProgramResult plain = play("ws://127.0.0.1", {});
  EXPECT_EQ(plain.exit_code, 1);
  EXPECT_THAT(plain.err, HasSubstr("a server with TLS is at wss://"));
  server_.emplace(VAT_PROGRAM,
                  std::vector<std::string>{"serve", "--port", "0", "--scene", test_scene("pair"),
                                           "--log-level", "off", "--handshake-seconds", "0.2"});
  EXPECT_FALSE(server_->is_secure());
  const ProgramResult secure = play("wss://127.0.0.1", {"--insecure"});
  EXPECT_EQ(secure.exit_code, 1);
  EXPECT_THAT(secure.err, HasSubstr("a server without TLS is at ws://"));
}

TEST_F(VatScriptTls, OptionsWithoutUseAreRefused) {
  EXPECT_EQ(play("wss://localhost", {"--ca", certificate_, "--insecure"}).exit_code, 2);
  EXPECT_EQ(play("wss://localhost", {"--ca", folder_.file("none.pem")}).exit_code, 2);
  for (const std::vector<std::string>& options :
       {std::vector<std::string>{"--insecure"}, {"--ca", certificate_}}) {
    const ProgramResult result = play("ws://localhost", options);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, HasSubstr("wss://"));
  }
}

}  // namespace
}  // namespace vat::test::script_tls_test
