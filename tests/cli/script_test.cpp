// `vat script` as a user runs it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/script/server_process.h"
#include "tests/cli/program.h"

namespace vat::test::script_test {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;

/// Scripts in a folder of their own, played by the built program.
class VatScript : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& lines) {
    folder_.write(name, lines);
    return (folder_.path() / name).string();
  }
  static ProgramResult play(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"script", "--scene", test_scene("pair")});
    return run_vat(arguments);
  }
  std::string met() {
    return write("met.jsonl",
                 "{\"connect\": \"a\"}\n{\"call\": \"session.join\"}\n{\"wait_ticks\": 2}\n");
  }
  std::string unmet() {
    return write("unmet.jsonl",
                 "{\"connect\": \"a\"}\n\n{\"call\": \"session.list\", \"result\": {\"x\": 1}}\n");
  }
  std::string mistaken() { return write("mistaken.jsonl", "{\"conect\": \"a\"}\n"); }
  std::string with_arguments() {
    return write("own.jsonl", "{\"server\": [\"--max-clients\", \"1\"]}\n{\"connect\": \"a\"}\n");
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
  EXPECT_THAT(both.out,
              EndsWith("passed over: it needs a server of its own, with --max-clients 1\n"));
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
  const std::string script = write(
      "set.jsonl",
      "{\"connect\": \"a\"}\n{\"call\": \"server.info\", \"result\": {\"name\": \"$who\"}}\n");
  EXPECT_EQ(play({"--set", "who", "vat", "--", script}).exit_code, 0);
  EXPECT_EQ(play({"--set", "who", "tav", "--", script}).exit_code, 1);
}

TEST_F(VatScript, ATranscriptHasEveryMessage) {
  const std::string script = write("talk.jsonl",
                                   "{\"connect\": \"a\"}\n{\"send_text\": \"{\", \"wrong\": "
                                   "true}\n{\"expect\": {\"id\": null}}\n");
  const std::string folder = (folder_.path() / "transcripts").string();
  EXPECT_EQ(play({"--transcript", folder, script}).exit_code, 0);
  const std::vector<std::string> lines = lines_of(read_file(folder + "/talk.jsonl"));
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0], R"({"connection":"a#1","sent":"{","wrong":true})");
  EXPECT_THAT(lines[1], HasSubstr(R"({"connection":"a#1","received":"{\"error\":)"));
}

}  // namespace
}  // namespace vat::test::script_test
