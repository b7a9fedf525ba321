// The viewer's site: paths, files and server information.

#include "server/http/http_site.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "server/http/request_path.h"
#include "tests/server/transport/transport_fixture.h"
#include "tests/support/temporary_folder.h"

namespace vat::test::http_site_test {

namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

TEST(RequestPath, Decodes) {
  EXPECT_EQ(request_path("/"), "/");
  EXPECT_EQ(request_path("/a/b.js"), "/a/b.js");
  EXPECT_EQ(request_path("/a%20b%2Fc%c3%A4"), "/a b/c\xc3\xa4");
  EXPECT_EQ(request_path("/a?../b"), "/a");
  EXPECT_EQ(request_path("/a#b"), "/a");
  EXPECT_EQ(request_path("/%2525"), "/%25");  // once, not twice
  EXPECT_EQ(request_path("/...a/b..c/..d"), "/...a/b..c/..d");
}

// Invalid paths: no path, broken escapes, parent folders, and zero bytes.
TEST(RequestPath, RefusesInvalidPaths) {
  const char* const malformed[] = {
      "",    "a",    "*",    "?",   "http://x/a", "example.org:80", "%2fa",      "/%",
      "/%2", "/%zz", "/%2g", "/a%", "/%%41",      "/%+1",           "/a%00.html"};
  const char* const other_folders[] = {
      "/..",        "/../",      "/../../etc/passwd", "/a/..",       "/a/../b", "/./a",
      "/.",         "/%2e%2e/a", "/.%2E/a",           "/a%2f..%2fb", "/%2e",    "/a/..?x",
      "/..\\..\\a", "/a\\b",     "/a%5c..",           "/a/%2e%2e"};
  for (const char* target : malformed) EXPECT_EQ(request_path(target), std::nullopt) << target;
  for (const char* target : other_folders) EXPECT_EQ(request_path(target), std::nullopt) << target;
  EXPECT_EQ(request_path(std::string("/a\0b", 4)), std::nullopt);
}

/// The viewer's folder, and a file outside it.
class HttpSite : public testing::Test {
 protected:
  HttpSite() {
    folder.write("secret.txt", "secret");
    folder.write("dist/index.html", "<title>vat</title>");
    folder.write("dist/assets/index-1a2b3c.js", std::string("x\0\r\n", 4));
    folder.write("dist/assets/deep/a b.js", "");
    folder.write("dist/favicon.svg", "<svg/>");
    folder.write("dist/.env", "secret");
    folder.write("dist/.git/config", "secret");
    fs::create_symlink(folder.path() / "secret.txt", folder.path() / "dist/link.txt");
    fs::create_directory_symlink(folder.path(), folder.path() / "dist/linked");
    fs::create_symlink(folder.path() / "nowhere", folder.path() / "dist/broken.txt");
    site = make_site(folder.path() / "dist");
  }
  HttpHandler make_site(const fs::path& dist) {
    Result<StaticFiles> files = StaticFiles::read(dist);
    EXPECT_TRUE(files.ok());
    return make_http_site(std::move(files).value(),
                          {[] { return "vat_threads 4\n"; },
                           [] { return R"({"traceEvents":[]})"; },
                           [](std::string_view authorization) { return authorization != "wrong"; },
                           [this] { return phase; },
                           [] { return R"({"status":"ok"})"; },
                           R"({"version":"1.2.3"})",
                           {"https://a.example", "http://b.example:8888"}});
  }

  const TemporaryFolder folder;
  ServerPhase phase = ServerPhase::ready;
  HttpHandler site;
};

std::string header(const HttpResponse& response, const std::string& name) {
  for (const auto& [key, value] : response.headers) {
    if (key == name) return value;
  }
  return "";
}

TEST_F(HttpSite, AnswersByThePath) {
  const std::string for_ever = "public, max-age=31536000, immutable";
  const std::string script(std::string("x\0\r\n", 4));
  struct Case {
    std::vector<const char*> targets;
    int status;
    std::string type, cache, body;
  };
  for (const Case& expected :
       {Case{{"/", "/index.html", "/?session=1", "/#top"},
             200,
             "text/html; charset=utf-8",
             "no-cache",
             "<title>vat</title>"},
        Case{{"/assets/index-1a2b3c.js"}, 200, "text/javascript; charset=utf-8", for_ever, script},
        Case{{"/assets/deep/a%20b.js"}, 200, "text/javascript; charset=utf-8", for_ever, ""},
        Case{{"/favicon.svg"}, 200, "image/svg+xml", "no-cache", "<svg/>"},
        Case{{"/healthz"}, 200, "application/json", "no-store", "{\"status\":\"ok\"}\n"},
        Case{{"/version"}, 200, "application/json", "no-store", "{\"version\":\"1.2.3\"}\n"},
        Case{{"/slow-ticks"}, 200, "application/json", "no-store", R"({"traceEvents":[]})"},
        Case{{"/metrics"},
             200,
             "text/plain; version=0.0.4; charset=utf-8",
             "no-store",
             "vat_threads 4\n"}}) {
    for (const char* target : expected.targets) {
      SCOPED_TRACE(target);
      const HttpResponse reply = site({"GET", target});
      EXPECT_EQ(reply.status, expected.status);
      EXPECT_EQ(reply.content_type, expected.type);
      EXPECT_EQ(header(reply, "Cache-Control"), expected.cache);
      EXPECT_EQ(reply.body, expected.body);
      EXPECT_EQ(site({"HEAD", target}).status, expected.status);
    }
  }
}

TEST_F(HttpSite, OtherMethodsAreRefused) {
  for (const char* method : {"POST", "PUT", "DELETE", "OPTIONS", "TRACE", "PATCH", "get"}) {
    const HttpResponse reply = site({method, "/"});
    EXPECT_EQ(reply.status, 405) << method;
    EXPECT_EQ(header(reply, "Allow"), "GET, HEAD");
    EXPECT_EQ(reply.body.find("<title>"), std::string::npos);
  }
}

TEST_F(HttpSite, NoPathLeadsOutOfTheFolderOrToHiddenFilesAndLinks) {
  const std::string absolute = folder.path().string() + "/secret.txt";
  for (const char* target :
       {"/../secret.txt", "/..%2fsecret.txt", "/%252e%252e/secret.txt", "/index.html%00.js",
        "//index.html", "/INDEX.HTML", "//etc/passwd", "/link.txt", "/linked/secret.txt",
        "/broken.txt", "/.env", "/.git/config", "/assets/", "/assets", "/assets/index-old.js",
        "/~root", absolute.c_str()}) {
    const HttpResponse reply = site({"GET", target});
    EXPECT_TRUE(reply.status == 400 || reply.status == 404) << target << ' ' << reply.status;
    EXPECT_EQ(reply.body.find("secret"), std::string::npos) << target;
    EXPECT_EQ(header(reply, "Cache-Control"), "no-store") << target;
  }
}

TEST_F(HttpSite, EveryAnswerHasTheSecurityHeaders) {
  for (const char* target :
       {"/", "/missing", "/healthz", "/readyz", "/version", "/metrics", "/slow-ticks", "/%zz"}) {
    const HttpResponse reply = site({"GET", target});
    EXPECT_EQ(header(reply, "X-Content-Type-Options"), "nosniff") << target;
    EXPECT_EQ(header(reply, "Referrer-Policy"), "no-referrer") << target;
    EXPECT_EQ(header(reply, "Cross-Origin-Resource-Policy"), "same-origin") << target;
    const std::string policy = header(reply, "Content-Security-Policy");
    for (const char* part :
         {"default-src 'none'", "script-src 'self'", "style-src 'self'", "base-uri 'none'",
          "form-action 'none'", "frame-ancestors 'self' https://a.example http://b.example:8888"}) {
      EXPECT_THAT(policy, HasSubstr(part)) << target;
    }
    EXPECT_EQ(policy.find("unsafe"), std::string::npos) << target;
  }
}

TEST_F(HttpSite, MetricsNeedAuthorisation) {
  for (const char* method : {"GET", "HEAD"}) {
    for (const char* target : {"/metrics", "/slow-ticks"}) {
      EXPECT_EQ(site({method, target, "", "", "right"}).status, 200);
      const HttpResponse refused = site({method, target, "", "", "wrong"});
      EXPECT_EQ(refused.status, 401);
      EXPECT_EQ(header(refused, "WWW-Authenticate"), "Bearer");
      EXPECT_EQ(refused.content_type, "text/plain; charset=utf-8");
      EXPECT_EQ(refused.body.find("vat_threads"), std::string::npos);
    }
  }
  EXPECT_EQ(site({"GET", "/healthz", "", "", "wrong"}).status, 200);
}

TEST_F(HttpSite, SendsTheEncodingThatTheClientPrefers) {
  folder.write("dist/assets/main.js", "the text itself");
  folder.write("dist/assets/main.js.br", "brotli");
  folder.write("dist/assets/main.js.gz", "gzipped");
  folder.write("dist/alone.gz", "a file without a plain one");
  const HttpHandler files = make_site(folder.path() / "dist");
  struct Case {
    const char* accepted;
    const char* encoding;  // empty: identity
    const char* body;
  };
  for (const Case& one :
       {Case{"", "", "the text itself"}, Case{"gzip, deflate, br, zstd", "br", "brotli"},
        Case{"gzip", "gzip", "gzipped"}, Case{"br;q=0, gzip;q=0.1", "gzip", "gzipped"},
        Case{"identity, br;q=0.5", "", "the text itself"}, Case{"*", "br", "brotli"},
        Case{"identity;q=0", "", "the text itself"}}) {
    const HttpResponse reply = files({"GET", "/assets/main.js", one.accepted});
    EXPECT_EQ(reply.status, 200) << one.accepted;
    EXPECT_EQ(reply.body, one.body) << one.accepted;
    EXPECT_EQ(header(reply, "Content-Encoding"), one.encoding) << one.accepted;
    EXPECT_EQ(header(reply, "Vary"), "Accept-Encoding");
    EXPECT_EQ(reply.content_type, "text/javascript; charset=utf-8");
  }
  EXPECT_EQ(files({"GET", "/assets/main.js.br"}).status, 404);
  EXPECT_EQ(files({"GET", "/alone.gz"}).status, 200);
  EXPECT_EQ(header(files({"GET", "/favicon.svg", "br"}), "Vary"), "");
}

TEST_F(HttpSite, AnUnchangedFileIsNotSentAgain) {
  folder.write("dist/assets/main.js", "the text itself");
  folder.write("dist/assets/main.js.br", "brotli");
  const HttpHandler files = make_site(folder.path() / "dist");
  const std::string plain = header(files({"GET", "/assets/main.js"}), "ETag");
  const std::string brotli = header(files({"GET", "/assets/main.js", "br"}), "ETag");
  EXPECT_NE(plain, brotli) << "a strong tag differs for each encoding";
  EXPECT_THAT(plain, testing::MatchesRegex("\"[0-9a-f]{32}\""));
  for (const std::string& tags : {brotli, "\"x\", " + brotli, "W/" + brotli, std::string("*")}) {
    const HttpResponse reply = files({"GET", "/assets/main.js", "br", tags});
    EXPECT_EQ(reply.status, 304) << tags;
    EXPECT_EQ(reply.body, "");
    EXPECT_EQ(header(reply, "ETag"), brotli);
    EXPECT_EQ(header(reply, "Vary"), "Accept-Encoding");
    EXPECT_EQ(header(reply, "Cache-Control"), "public, max-age=31536000, immutable");
  }
  for (const std::string& tags : {plain, std::string("x"), brotli.substr(1)}) {
    EXPECT_EQ(files({"GET", "/assets/main.js", "br", tags}).status, 200) << tags;
  }
  folder.write("dist/index.html", "<title>new</title>");
  const HttpHandler rebuilt = make_site(folder.path() / "dist");
  EXPECT_EQ(rebuilt({"GET", "/", "", header(files({"GET", "/"}), "ETag")}).status, 200);
}

TEST_F(HttpSite, ReadyMeansThatSessionsCanBeCreated) {
  const std::map<ServerPhase, std::string> phases = {{ServerPhase::starting, "starting"},
                                                     {ServerPhase::recovering, "recovering"},
                                                     {ServerPhase::ready, "ready"},
                                                     {ServerPhase::draining, "draining"},
                                                     {ServerPhase::replaced, "replaced"}};
  for (const auto& [now, name] : phases) {
    phase = now;
    const HttpResponse reply = site({"GET", "/readyz"});
    EXPECT_EQ(reply.status, now == ServerPhase::ready ? 200 : 503) << name;
    EXPECT_EQ(reply.body, "{\"status\":\"" + name + "\"}\n");
    EXPECT_EQ(site({"GET", "/healthz"}).status, now == ServerPhase::replaced ? 503 : 200) << name;
  }
}

TEST_F(HttpSite, WithoutAViewerTheRootExplainsItsBuild) {
  const HttpHandler empty = make_site(folder.path() / "none");
  EXPECT_EQ(empty({"GET", "/"}).status, 503);
  EXPECT_THAT(empty({"GET", "/"}).body, HasSubstr("./vat serve"));
  EXPECT_EQ(empty({"GET", "/assets/x.js"}).status, 404);
  const Result<StaticFiles> file = StaticFiles::read(folder.path() / "secret.txt");
  ASSERT_FALSE(file.ok()) << "not a folder";
  EXPECT_THAT(file.errors().front().message, HasSubstr("secret.txt"));
}

TEST(StaticFiles, LimitsHold) {
  TemporaryFolder folder;
  folder.write("a", "12345");
  folder.write("b", "12345");
  EXPECT_TRUE(StaticFiles::read(folder.path(), {2, 10}).ok());
  EXPECT_FALSE(StaticFiles::read(folder.path(), {1, 10}).ok());
  EXPECT_FALSE(StaticFiles::read(folder.path(), {2, 9}).ok());
}

TEST(StaticFiles, ContentTypes) {
  EXPECT_EQ(content_type_of("a.min.js"), "text/javascript; charset=utf-8");
  EXPECT_EQ(content_type_of("a.css"), "text/css; charset=utf-8");
  EXPECT_EQ(content_type_of("a.png"), "image/png");
  EXPECT_EQ(content_type_of("a.json"), "application/json");
  EXPECT_EQ(content_type_of("a.js.map"), "application/json");
  EXPECT_EQ(content_type_of("a.wasm"), "application/wasm");
  EXPECT_EQ(content_type_of("LICENSE"), "application/octet-stream");
}

class ServedSite : public TransportTest {};

// Runs the health check command of the image over a real socket.
TEST_F(ServedSite, PassesTheHealthCheckOfTheImage) {
  http_handler =
      make_http_site(StaticFiles::read("/none").value(),
                     {[] { return ""; }, [] { return ""; }, [](std::string_view) { return true; },
                      [] { return ServerPhase::ready; }, [] { return "{}"; }, "{}"});
  start();
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

}  // namespace

}  // namespace vat::test::http_site_test
