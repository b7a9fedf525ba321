#include "server/http/static_files.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/support/temporary_folder.h"

namespace vat::test::static_files_test {

namespace {

namespace fs = std::filesystem;

StaticFiles read(const TemporaryFolder& folder) {
  Result<StaticFiles> files = StaticFiles::read(folder.path());
  EXPECT_TRUE(files.ok()) << (files.ok() ? "" : files.errors().front().message);
  return std::move(files).value();
}

TEST(StaticFiles, ReadsTheTree) {
  TemporaryFolder folder;
  folder.write("index.html", "<p>");
  folder.write("assets/deep/a b.js", std::string("x\0\r\n", 4));
  folder.write("empty.css", "");
  const StaticFiles files = read(folder);
  ASSERT_NE(files.find("/index.html"), nullptr);
  EXPECT_EQ(files.find("/index.html")->content, "<p>");
  ASSERT_NE(files.find("/assets/deep/a b.js"), nullptr);
  EXPECT_EQ(files.find("/assets/deep/a b.js")->content, std::string("x\0\r\n", 4));
  ASSERT_NE(files.find("/empty.css"), nullptr);
  EXPECT_EQ(files.find("/empty.css")->content, "");
  for (const char* path :
       {"", "/", "index.html", "/assets", "/assets/", "//index.html", "/INDEX.HTML"}) {
    EXPECT_EQ(files.find(path), nullptr) << path;
  }
}

TEST(StaticFiles, LeavesOutLinksAndHiddenFiles) {
  TemporaryFolder outside;
  outside.write("secret.txt", "secret");
  TemporaryFolder folder;
  folder.write("index.html", "");
  folder.write(".env", "hidden");
  folder.write(".git/config", "hidden");
  fs::create_symlink(outside.path() / "secret.txt", folder.path() / "link.txt");
  fs::create_directory_symlink(outside.path(), folder.path() / "linked");
  fs::create_symlink(folder.path() / "nowhere", folder.path() / "broken.txt");
  const StaticFiles files = read(folder);
  EXPECT_NE(files.find("/index.html"), nullptr);
  for (const char* path :
       {"/link.txt", "/linked/secret.txt", "/broken.txt", "/.env", "/.git/config"}) {
    EXPECT_EQ(files.find(path), nullptr) << path;
  }
}

TEST(StaticFiles, AFolderThatDoesNotExistIsEmpty) {
  TemporaryFolder folder;
  const Result<StaticFiles> files = StaticFiles::read(folder.path() / "dist");
  ASSERT_TRUE(files.ok());
  EXPECT_TRUE(files.value().empty());
}

TEST(StaticFiles, AFileInPlaceOfTheFolderIsAnError) {
  TemporaryFolder folder;
  folder.write("dist", "");
  const Result<StaticFiles> files = StaticFiles::read(folder.path() / "dist");
  ASSERT_FALSE(files.ok());
  EXPECT_NE(files.errors().front().message.find("dist"), std::string::npos);
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
  EXPECT_EQ(content_type_of("index.html"), "text/html; charset=utf-8");
  EXPECT_EQ(content_type_of("a.min.js"), "text/javascript; charset=utf-8");
  EXPECT_EQ(content_type_of("a.css"), "text/css; charset=utf-8");
  EXPECT_EQ(content_type_of("a.svg"), "image/svg+xml");
  EXPECT_EQ(content_type_of("a.png"), "image/png");
  EXPECT_EQ(content_type_of("a.json"), "application/json");
  EXPECT_EQ(content_type_of("a.js.map"), "application/json");
  EXPECT_EQ(content_type_of("a.wasm"), "application/wasm");
  EXPECT_EQ(content_type_of("LICENSE"), "application/octet-stream");
}

}  // namespace

}  // namespace vat::test::static_files_test
