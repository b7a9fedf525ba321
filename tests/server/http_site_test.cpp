#include "server/http/http_site.h"

#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <tuple>
#include <utility>

#include "tests/server/transport_fixture.h"
#include "tests/support/temporary_folder.h"

namespace vat::test::http_site_test {

namespace {

/// The viewer's site over a real socket.
class HttpSiteTest : public TransportTest {
 protected:
  void serve() {
    Result<StaticFiles> files = StaticFiles::read(folder.path() / "dist");
    ASSERT_TRUE(files.ok());
    http_handler = make_http_site(std::move(files).value(),
                                  {[] { return "vat_threads 4\n"; },
                                   [this] { return phase.load(); }, R"({"version":"1.2.3"})"});
    start();
  }
  void serve_viewer() {
    folder.write("secret.txt", "secret");
    folder.write("dist/index.html", "<title>vat</title>");
    folder.write("dist/assets/index-1a2b3c.js", "let x;");
    folder.write("dist/favicon.svg", "<svg/>");
    std::filesystem::create_symlink(folder.path() / "secret.txt", folder.path() / "dist/link.txt");
    serve();
  }

  TemporaryFolder folder;
  SharedPhase phase = ServerPhase::ready;
};

TEST_F(HttpSiteTest, TheRootIsTheIndex) {
  serve_viewer();
  for (const char* target : {"/", "/index.html", "/?session=1", "/#top"}) {
    const HttpReply reply = http(port, "GET", target);
    EXPECT_EQ(reply.status, 200) << target;
    EXPECT_EQ(reply.body, "<title>vat</title>");
    EXPECT_EQ(reply.header("Content-Type"), "text/html; charset=utf-8");
    EXPECT_EQ(reply.header("Cache-Control"), "no-cache");
  }
}

TEST_F(HttpSiteTest, OnlyHashedFilesAreKeptForEver) {
  serve_viewer();
  const HttpReply script = http(port, "GET", "/assets/index-1a2b3c.js");
  EXPECT_EQ(script.body, "let x;");
  EXPECT_EQ(script.header("Content-Type"), "text/javascript; charset=utf-8");
  EXPECT_EQ(script.header("Cache-Control"), "public, max-age=31536000, immutable");
  EXPECT_EQ(http(port, "GET", "/favicon.svg").header("Cache-Control"), "no-cache");
  EXPECT_EQ(http(port, "GET", "/assets/index-old.js").header("Cache-Control"), "no-store");
}

TEST_F(HttpSiteTest, HeadIsGetWithoutTheBody) {
  serve_viewer();
  const HttpReply get = http(port, "GET", "/");
  const HttpReply head = http(port, "HEAD", "/");
  EXPECT_EQ(head.head, get.head);
  EXPECT_EQ(head.body, "");
}

TEST_F(HttpSiteTest, OtherMethodsAreRefused) {
  serve_viewer();
  for (const char* method : {"POST", "PUT", "DELETE", "OPTIONS", "TRACE", "PATCH", "get"}) {
    const HttpReply reply = http(port, method, "/");
    EXPECT_EQ(reply.status, 405) << method;
    EXPECT_EQ(reply.header("Allow"), "GET, HEAD");
    EXPECT_EQ(reply.body.find("<title>"), std::string::npos);
  }
}

TEST_F(HttpSiteTest, NoPathLeadsOutOfTheFolder) {
  serve_viewer();
  for (const char* target :
       {"/../secret.txt", "/%2e%2e/secret.txt", "/..%2fsecret.txt", "/assets/../../secret.txt",
        "/assets/..%5c..%5csecret.txt", "/%252e%252e/secret.txt", "/..%00/secret.txt",
        "//etc/passwd", "/index.html%00.js", "/link.txt", "/%c0%ae%c0%ae/secret.txt",
        "../secret.txt", "/./../secret.txt", "/assets/", "/assets", "/.", "/~root"}) {
    const HttpReply reply = http(port, "GET", target);
    EXPECT_TRUE(reply.status == 400 || reply.status == 404) << target << ' ' << reply.status;
    EXPECT_EQ(reply.body.find("secret"), std::string::npos) << target;
  }
  const std::string absolute = folder.path().string() + "/secret.txt";
  EXPECT_EQ(http(port, "GET", absolute).status, 404);
}

TEST_F(HttpSiteTest, EveryAnswerHasTheSecurityHeaders) {
  serve_viewer();
  for (const char* target :
       {"/", "/missing", "/healthz", "/readyz", "/version", "/metrics", "/%zz"}) {
    const HttpReply reply = http(port, "GET", target);
    EXPECT_EQ(reply.header("X-Content-Type-Options"), "nosniff") << target;
    EXPECT_EQ(reply.header("Referrer-Policy"), "no-referrer") << target;
    const std::string policy = reply.header("Content-Security-Policy");
    for (const char* part :
         {"default-src 'self'", "worker-src 'self' blob:", "connect-src 'self' ws: wss:",
          "style-src 'self' 'unsafe-inline'", "img-src 'self' data: blob:"}) {
      EXPECT_NE(policy.find(part), std::string::npos) << target << ' ' << policy;
    }
  }
}

TEST_F(HttpSiteTest, Health) {
  serve();
  const HttpReply reply = http(port, "GET", "/healthz");
  EXPECT_EQ(reply.status, 200);
  EXPECT_EQ(reply.header("Content-Type"), "application/json");
  EXPECT_EQ(reply.header("Cache-Control"), "no-store");
  EXPECT_EQ(reply.body, "{\"status\":\"ok\"}\n");
}

// What the image asks, by its own words.
TEST_F(HttpSiteTest, TheHealthCheckOfTheImagePasses) {
  serve();
  std::ifstream file(VAT_SOURCE_DIR "/docker/Dockerfile");
  std::ostringstream text;
  text << file.rdbuf();
  std::string recipe = std::regex_replace(text.str(), std::regex(R"(\\\n)"), " ");
  std::smatch found;
  ASSERT_TRUE(std::regex_search(recipe, found, std::regex(R"(HEALTHCHECK .*CMD (\[.*\]))")));
  std::string command = nlohmann::json::parse(found.str(1)).at(2);
  const auto ask = [&](int at) {
    const std::string there = std::regex_replace(command, std::regex("8080"), std::to_string(at));
    return std::system(("exec bash -c \"" + there + "\" 2> /dev/null").c_str());
  };
  EXPECT_EQ(ask(port), 0) << command;
  transport->stop();
  EXPECT_NE(ask(port), 0);
}

TEST_F(HttpSiteTest, ReadyIsWhoTakesNewSessions) {
  serve();
  for (const auto& [now, status, name] : {std::tuple(ServerPhase::starting, 503, "starting"),
                                          std::tuple(ServerPhase::recovering, 503, "recovering"),
                                          std::tuple(ServerPhase::ready, 200, "ready"),
                                          std::tuple(ServerPhase::draining, 503, "draining")}) {
    phase = now;
    const HttpReply reply = http(port, "GET", "/readyz");
    EXPECT_EQ(reply.status, status) << name;
    EXPECT_EQ(reply.body, std::string("{\"status\":\"") + name + "\"}\n");
    EXPECT_EQ(http(port, "GET", "/healthz").status, 200) << name;
  }
}

TEST_F(HttpSiteTest, TheVersionIsJson) {
  serve();
  const HttpReply reply = http(port, "GET", "/version");
  EXPECT_EQ(reply.header("Content-Type"), "application/json");
  EXPECT_EQ(reply.body, "{\"version\":\"1.2.3\"}\n");
}

TEST_F(HttpSiteTest, Metrics) {
  serve();
  const HttpReply reply = http(port, "GET", "/metrics");
  EXPECT_EQ(reply.status, 200);
  EXPECT_EQ(reply.header("Content-Type"), "text/plain; version=0.0.4; charset=utf-8");
  EXPECT_EQ(reply.header("Cache-Control"), "no-store");
  EXPECT_EQ(reply.body, "vat_threads 4\n");
}

TEST_F(HttpSiteTest, WithoutAViewerTheRootSaysHowToBuildIt) {
  serve();
  const HttpReply reply = http(port, "GET", "/");
  EXPECT_EQ(reply.status, 503);
  EXPECT_NE(reply.body.find("./vat serve"), std::string::npos);
  EXPECT_EQ(http(port, "GET", "/assets/x.js").status, 404);
}

}  // namespace

}  // namespace vat::test::http_site_test
