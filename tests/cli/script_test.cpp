// `vat script` as a user runs it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/script/server_process.h"
#include "tests/cli/program.h"
#include "tests/support/certificate.h"

namespace vat::test::script_test {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;

/// Scripts in a separate folder, played by the built program.
class VatScript : public testing::Test {
 protected:
  /// Writes a script NAME.jsonl, and returns its path.
  std::string write(const std::string& name, const std::string& lines) {
    folder_.write(name + ".jsonl", lines);
    return folder_.file(name + ".jsonl");
  }
  static ProgramResult play(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"script", "--scene", test_scene("pair")});
    return run_vat(arguments);
  }
  std::string met() {
    return write("met", R"({"connect": "a"}
{"call": "session.join"}
{"wait_ticks": 2})");
  }
  std::string unmet() {
    return write("unmet", R"({"connect": "a"}

{"call": "session.list", "result": {"x": 1}})");
  }
  std::string mistaken() { return write("mistaken", R"({"conect": "a"})"); }
  std::string with_arguments() {
    return write("own", R"({"server": ["--max-clients", "1"]}
{"connect": "a"})");
  }

  TemporaryFolder folder_;
};

TEST_F(VatScript, EveryLineMetIsSuccess) {
  const ProgramResult result = play({met(), with_arguments()});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.out, HasSubstr("met.jsonl: 3 lines, all met\n"));
  EXPECT_THAT(result.out, EndsWith("own.jsonl: 2 lines, all met\n"));
  EXPECT_THAT(result.err, IsEmpty());
}

TEST_F(VatScript, ALineThatIsNotMetIsNamedAndTheOthersArePlayed) {
  const ProgramResult result = play({unmet(), met()});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("unmet.jsonl:3: at /result\n  expected a member \"x\"\n"));
  EXPECT_THAT(result.out, EndsWith("met.jsonl: 3 lines, all met\n"));
}

TEST_F(VatScript, AMistakeInAScriptIsWrongUse) {
  const ProgramResult result = play({mistaken(), unmet()});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("mistaken.jsonl:1: no known action"));
  EXPECT_EQ(play({(folder_.path() / "none.jsonl").string()}).exit_code, 2);
  const ProgramResult folder = play({folder_.path().string()});
  EXPECT_EQ(folder.exit_code, 2);
  EXPECT_THAT(folder.err, HasSubstr(": is a folder"));
  EXPECT_EQ(play({"--patience", "nan", met()}).exit_code, 2);
}

TEST_F(VatScript, PlaysAgainstAServerThatRuns) {
  script::ServerProcess server(
      VAT_PROGRAM, {"serve", "--port", "0", "--scene", test_scene("pair"), "--log-level", "error"});
  const std::string url = "ws://localhost:" + std::to_string(server.port());
  const ProgramResult both = play({"--server", url, met(), with_arguments()});
  EXPECT_EQ(both.exit_code, 0) << both.err;
  EXPECT_THAT(both.out, HasSubstr("met.jsonl: 3 lines, all met\n"));
  EXPECT_THAT(both.out, EndsWith("skipped: it needs a separate server, with --max-clients 1\n"));
  const ProgramResult none = play({"--server", url, with_arguments()});
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_TRUE(server.is_running());
}

TEST_F(VatScript, AServerThatIsNotThereIsAFailure) {
  const ProgramResult result = play({"--server", "ws://127.0.0.1:1", met()});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("met.jsonl:1: no server at 127.0.0.1:1"));
  EXPECT_EQ(play({"--server", "http://127.0.0.1:1", met()}).exit_code, 2);
}

TEST_F(VatScript, SetsTexts) {
  const std::string script = write("set", R"({"connect": "a"}
{"call": "server.info", "result": {"name": "$who"}})");
  EXPECT_EQ(play({"--set", "who", "vat", "--", script}).exit_code, 0);
  EXPECT_EQ(play({"--set", "who", "tav", "--", script}).exit_code, 1);
}

TEST_F(VatScript, ATranscriptHasEveryMessage) {
  const std::string script = write("talk", R"({"connect": "a"}
{"send_text": "{", "wrong": true}
{"expect": {"id": null}})");
  const std::string folder = (folder_.path() / "transcripts").string();
  EXPECT_EQ(play({"--transcript", folder, script}).exit_code, 0);
  const std::vector<std::string> lines = lines_of(read_file(folder + "/talk.jsonl"));
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0], R"({"connection":"a#1","sent":"{","wrong":true})");
  EXPECT_THAT(lines[1], HasSubstr(R"({"connection":"a#1","received":"{\"error\":)"));
}

// `vat script` over TLS: trusted certificates.

/// A server with TLS, and a script for it.
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
  /// Plays the script against this host with these options.
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

TEST_F(VatScriptTls, PlaysIfTheCertificateIsTrusted) {
  EXPECT_TRUE(server_->is_secure());
  for (const char* host : {"wss://localhost", "wss://127.0.0.1"}) {
    const ProgramResult result = play(host, {"--ca", certificate_});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.out, HasSubstr("met.jsonl: 2 lines, all met\n"));
  }
}

TEST_F(VatScriptTls, AnUntrustedCertificateIsRefused) {
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

TEST_F(VatScriptTlsOfAnother, InsecureAcceptsAnyServer) {
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
}  // namespace vat::test::script_test
