#include "server/operations/log_format.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/logger.h>
#include <spdlog/sinks/ostream_sink.h>

#include <nlohmann/json.hpp>
#include <sstream>

namespace vat::test::log_format_test {
namespace {

std::string logged(const std::string& message, spdlog::level::level_enum level) {
  std::ostringstream out;
  const auto sink = std::make_shared<spdlog::sinks::ostream_sink_st>(out);
  spdlog::logger logger("test", sink);
  logger.set_level(spdlog::level::debug);
  logger.set_formatter(std::make_unique<JsonLogFormatter>());
  logger.log(level, message);
  return out.str();
}

TEST(JsonLog, OneObjectALine) {
  const std::string line = logged("session s1 created", spdlog::level::warn);
  ASSERT_TRUE(line.ends_with("}\n"));
  const nlohmann::json object = nlohmann::json::parse(line);
  EXPECT_EQ(object.at("level"), "warning");
  EXPECT_EQ(object.at("message"), "session s1 created");
  EXPECT_THAT(object.at("time").get<std::string>(),
              testing::MatchesRegex("20[0-9]+-[0-9]+-[0-9]+T[0-9:]+\\.[0-9][0-9][0-9]Z"));
  EXPECT_EQ(object.size(), 3U);
}

// User text in a message must not add a line or a member.
TEST(JsonLog, NothingInAMessageLeavesIt) {
  for (const std::string& message :
       {std::string("a\nb"), std::string(R"(", "level": "critical)"), std::string("\x1b[31m"),
        std::string("a\0b", 3), std::string("\xff\xfe"), std::string("\xe2\x80\xa8")}) {
    const std::string line = logged(message, spdlog::level::info);
    EXPECT_EQ(line.find('\n'), line.size() - 1);
    EXPECT_EQ(line.find('\x1b'), std::string::npos);
    const nlohmann::json object = nlohmann::json::parse(line);
    EXPECT_EQ(object.at("level"), "info");
    if (message == "\xff\xfe") continue;
    EXPECT_EQ(object.at("message"), message);
  }
}

}  // namespace
}  // namespace vat::test::log_format_test
