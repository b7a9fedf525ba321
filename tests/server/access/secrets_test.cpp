// Neither the log nor the data folder contains a token.

#include <gmock/gmock.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <iterator>
#include <sstream>

#include "server/cli/serve/serve_access.h"
#include "tests/server/fixture/session_fixture.h"
#include "tests/support/temporary_folder.h"

namespace vat::test::secrets_test {
namespace {

using testing::HasSubstr;
using testing::Not;

/// Stores the complete log at the most verbose level during its lifetime.
class CapturedLog {
 public:
  CapturedLog() : before_(spdlog::default_logger()) {
    const auto sink = std::make_shared<spdlog::sinks::ostream_sink_mt>(text_);
    const auto logger = std::make_shared<spdlog::logger>("captured", sink);
    logger->set_level(spdlog::level::trace);
    spdlog::set_default_logger(logger);
  }
  ~CapturedLog() { spdlog::set_default_logger(before_); }
  CapturedLog(const CapturedLog&) = delete;
  CapturedLog& operator=(const CapturedLog&) = delete;

  std::string text() const { return text_.str(); }

 private:
  const std::shared_ptr<spdlog::logger> before_;
  std::ostringstream text_;
};

/// A server with a data folder and access by token. Its clients use every kind of secret.
class Secrets : public testing::Test {
 protected:
  Secrets() : catalogue_(make_catalogue()) {}

  void use_every_secret() {
    ServerSettings settings = test_settings(unhurried_limits(), folder.file("data"));
    settings.access.mode = AccessMode::token;
    TestServer server(catalogue_, settings);
    ASSERT_TRUE(server.create_session("first", to_scene(mixed_scene_text())).ok());
    TestClient admin(server, 1);
    enter(admin, std::string(kAdminToken));
    const std::string ticket =
        keep(admin.result("access.ticket", {{"role", "controller"}}), "token");
    TestClient owner(server, 2);
    enter(owner, ticket);
    const std::string session = owner.create_session();
    const std::string resume = keep(owner.result("session.join", {{"session", session}}), "resume");
    keep(owner.result("scene.save", {{"name", "saved"}}), "key");
    keep(owner.result("recording.export"), "path");
    const std::string invitation =
        keep(owner.result("session.invite", {{"role", "viewer"}}), "token");
    TestClient guest(server, 3);
    enter(guest, invitation);
    guest.result("session.join");
    owner.disconnect();
    TestClient again(server, 4);
    enter(again, invitation);
    again.result("session.join", {{"session", session}, {"resume", resume}});
    show_wrong_ones(server);
    server.flush();
    server.stop();
  }
  /// Returns the content of all files of the data folder.
  std::string stored() const {
    std::string all;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path())) {
      if (!entry.is_regular_file()) continue;
      std::ifstream file(entry.path(), std::ios::binary);
      all.append(std::istreambuf_iterator<char>(file), {});
    }
    return all;
  }

  const TemporaryFolder folder;
  std::vector<std::string> secrets{std::string(kAdminToken)};

 private:
  static void enter(TestClient& client, const std::string& token) {
    client.result("access.enter", {{"token", token}});
  }
  std::string keep(const Json& result, const char* member) {
    secrets.push_back(result.at(member));
    return secrets.back();
  }
  /// Sends tokens in messages that the server rejects.
  void show_wrong_ones(TestServer& server) {
    const std::string wrong = "a wrong token, such as a password";
    secrets.push_back(wrong);
    TestClient stranger(server, 5);
    stranger.error("access.enter", {{"token", wrong}});
    stranger.error(wrong, {{"token", wrong}});
    stranger.send_raw(wrong, true);
    stranger.error("access.enter", {{"token", {wrong}}, {wrong, 1}});
  }

  const Catalogue catalogue_;
};

TEST_F(Secrets, AreNeitherLoggedNorStored) {
  const CapturedLog log;
  use_every_secret();
  ASSERT_EQ(secrets.size(), 7U);
  const std::string text = log.text();
  EXPECT_THAT(text, HasSubstr("session s2 created")) << "the log was captured";
  EXPECT_THAT(text, HasSubstr("a wrong token, number 1"));
  const std::string all = stored();
  EXPECT_THAT(all, HasSubstr("first")) << "the data was read";
  for (const std::string& secret : secrets) {
    EXPECT_THAT(text, Not(HasSubstr(secret)));
    EXPECT_EQ(all.find(secret), std::string::npos);
  }
}

TEST_F(Secrets, TheAdminLinkIsPrintedAndNotLogged) {
  const CapturedLog log;
  ServeSettings settings;
  settings.access = "token";
  unsetenv("VAT_ADMIN_TOKEN");
  const ServeAccess access = serve_access(settings).value();
  ASSERT_FALSE(access.made_token.empty());
  testing::internal::CaptureStdout();
  tell_access(settings, access, "http://127.0.0.1:8080/");
  EXPECT_EQ(testing::internal::GetCapturedStdout(),
            "the admin enters at http://127.0.0.1:8080/#ticket=" + access.made_token + "\n");
  EXPECT_EQ(log.text(), "");
}

}  // namespace
}  // namespace vat::test::secrets_test
