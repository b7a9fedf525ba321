#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <string>

#include "server/script/transcript.h"

namespace vat::test {

/// "Suite.Test"; of a test with parameters also these, with - for /.
inline std::string name_of_test() {
  const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
  if (test == nullptr) return "none";
  std::string name = std::string(test->test_suite_name()) + '.' + test->name();
  std::ranges::replace(name, '/', '-');
  return name;
}

/// The transcript of the test that runs, in the folder that $VAT_TRANSCRIPT names; null where it
/// names none. What is in that folder is checked against the schemas once the tests have run.
inline script::Transcript* message_record() {
  static const char* const kFolder = std::getenv("VAT_TRANSCRIPT");
  static std::mutex mutex;
  static std::string recorded;  // the test whose transcript is open
  static std::unique_ptr<script::Transcript> transcript;
  if (kFolder == nullptr) return nullptr;
  const std::lock_guard lock(mutex);
  const std::string name = name_of_test();
  if (name != recorded) {
    transcript = std::make_unique<script::Transcript>(kFolder, name);
    recorded = name;
  }
  return transcript.get();
}

}  // namespace vat::test
