#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "tests/bench/document/document.h"
#include "tests/bench/document/markers.h"
#include "tests/bench/document/page_tables.h"
#include "tests/bench/report/table.h"
#include "tests/bench/validate/validate_table.h"
#include "tests/cli/program.h"
#include "tests/validation/cases.h"

namespace vat::bench::bench_document_test {
namespace {

namespace fs = std::filesystem;
using test::read_file;
using test::TemporaryFolder;
using testing::HasSubstr;

const fs::path kPage = fs::path(VAT_SOURCE_DIR) / "core/ACCURACY.md";

TEST(BenchDocument, FillsTheTextBetweenMarkers) {
  const Result<std::string> filled = fill_markers(
      "# Page\n<!-- begin a -->\nold\n| x |\n<!-- end a -->\nWords.\n"
      "<!-- begin b -->\n<!-- end b -->\n",
      {{"a", "new\n"}, {"b", "no line end"}});
  ASSERT_TRUE(filled);
  EXPECT_EQ(filled.value(),
            "# Page\n<!-- begin a -->\nnew\n<!-- end a -->\nWords.\n"
            "<!-- begin b -->\nno line end\n<!-- end b -->\n");
}

TEST(BenchDocument, RefusesMarkersThatDoNotFit) {
  const std::map<std::string, std::string> contents = {{"a", "new\n"}};
  const std::string good = "<!-- begin a -->\n<!-- end a -->\n";
  for (const auto& [page, message] : std::map<std::string, std::string>{
           {"", "has no place in the page"},
           {"<!-- begin a -->\n", "has a beginning but no end"},
           {"<!-- end a -->\n" + good, "has an end but no beginning"},
           {good + good, "comes twice"},
           {good + "<!-- begin c -->\n<!-- end c -->\n", "is nothing that can be filled in"},
           {"<!-- begin a -->\n" + good, "begins within a"}}) {
    const Result<std::string> filled = fill_markers(page, contents);
    ASSERT_FALSE(filled) << page;
    EXPECT_THAT(filled.errors(), testing::Contains(testing::Field(&Error::message, message)))
        << page;
  }
}

TEST(BenchDocument, FindsEachPictureOnce) {
  EXPECT_THAT(
      pictures_of("![A b](figures/a.svg) [no](c.svg)\n![](figures/d.svg) ![](figures/a.svg)"),
      testing::ElementsAre("figures/a.svg", "figures/d.svg"));
}

/// A marker of a page, the file of its results, and the lines of its table.
struct Filling {
  std::string marker;
  const char* file;
  std::vector<std::string> table;
};

/// Result files as the commands write them.
class Results {
 public:
  Results() {
    write("validate/validation.json",
          R"([{"case": "DEF-1", "metric": "x [m]", "measured": 1.5, "reference": 1,
               "must be": "1 +- 1", "share of tolerance": 0.5, "tolerance from": "theory",
               "passed": true},
              {"case": "DEF-1", "metric": "y [m]", "measured": 2.75, "reference": 2,
               "must be": "2 +- 1", "share of tolerance": 0.75, "tolerance from": "theory",
               "passed": true},
              {"case": "DEF-1", "metric": "z [m]", "measured": 4, "reference": 3,
               "must be": "reported: 3", "share of tolerance": null, "tolerance from": "too soft",
               "passed": null}])");
    write("accuracy/cheapest.json",
          R"([{"case": "P", "error at most": 0.01, "fewest evaluations": "heun, fixed",
               "evaluations per particle": 100},
              {"case": "P", "error at most": 1e-6, "fewest evaluations": "none reaches it",
               "evaluations per particle": null}])");
    write("accuracy/control.json",
          R"([{"case": "P", "error at most": 0.01, "best fixed": "heun",
               "its evaluations per particle": 100, "best adaptive": "heun",
               "evaluations / fixed": 0.5, "time / fixed": 0.625,
               "local: evaluations / fixed": null, "local: time / fixed": null}])");
    write("accuracy/solvers.json",
          R"([{"problem": "dam", "solver": "tait", "layers": 20, "error of": "front",
               "error": 0.125, "mean density error": 0.5, "greatest density error": 0.75,
               "steps": 7, "seconds": 1.5, "hash": "0"}])");
    write("accuracy/tolerances.json",
          R"([{"scene": "dam", "tolerance": 0.01, "failed": 0, "density error": 0.005, "steps": 7,
               "iterations for velocities": 1.5, "iterations for positions": 0.25,
               "seconds": 2}])");
    write("accuracy/laws.json",
          R"([{"problem": "P", "law": "penalties", "error at most": 0.01,
               "least time": "heun, fixed", "seconds": 0.00125},
              {"problem": "P", "law": "penalties", "error at most": 1e-6,
               "least time": "none reaches it", "seconds": null},
              {"problem": "P", "law": "projection", "error at most": 0.01,
               "least time": "heun, fixed", "seconds": 0.002},
              {"problem": "P", "law": "projection", "error at most": 1e-6,
               "least time": "heun, adaptive", "seconds": 0.5}])");
    write("stability/stability.json",
          R"([{"part": "random", "scenes": 30, "not finite": 0, "aborts": 0, "outside": 0,
               "guard events": 5, "retries": 6, "wall stops": 0, "stopped": 0, "refused": 0,
               "faults": 0, "seconds": 1.5}])");
    write("race/race.json",
          R"([{"case": "10k-tait", "particles": 10648, "threads": 2, "vat [s/s]": 2.5,
               "SPlisHSPlasH [s/s]": 10, "SPlisHSPlasH / vat": 4.125,
               "density error of vat [%]": 0.25, "cpu": "C", "cores": 2}])");
    write("accuracy/P-time.svg", "<svg></svg>");
  }

  std::string file(const std::string& name) const { return folder_.file(name); }
  void write(const std::string& name, const std::string& text) const { folder_.write(name, text); }
  /// Fills the page, which has the text. Returns the page.
  Result<std::string> fill(const std::string& text) const {
    write("page/page.md", text);
    const Status done = write_document(folder_.path(), file("page/page.md"));
    if (!done) return done.errors();
    return read_file(file("page/page.md"));
  }

 private:
  TemporaryFolder folder_;
};

std::string with_marker(const std::string& marker, const std::string& content) {
  return "<!-- begin " + marker + " -->\n" + content + "<!-- end " + marker + " -->\n";
}

TEST(BenchDocument, FillsEachTableWithItsResults) {
  const std::string title = validation::all_cases().front().title;
  const Filling fillings[] = {
      {"summary",
       "validate/validation.json",
       {"| case | quantity | measured | reference and tolerance |",
        "| " + title + " | y [m] | 2.75 | 2 +- 1 |"}},
      {"cases",
       "validate/validation.json",
       {"| case | subject | metrics | metric closest to its tolerance | measured | reference and "
        "tolerance |",
        "| DEF-1 | " + title + " | 3 | y [m] | 2.75 | 2 +- 1 |"}},
      {"limits",
       "validate/validation.json",
       {"| case | metric | measured | reference | cause |",
        "| DEF-1 | z [m] | 4 | 3 | too soft |"}},
      {"solvers",
       "accuracy/solvers.json",
       {"| problem | solver | layers | error of | error | mean density error | greatest density "
        "error | steps |",
        "| dam | tait | 20 | front | 0.125 | 0.5 | 0.75 | 7 |"}},
      {"tolerances",
       "accuracy/tolerances.json",
       {"| scene | tolerance | density error | steps | iterations for velocities | iterations for "
        "positions |",
        "| dam | 0.01 | 0.005 | 7 | 1.5 | 0.25 |"}},
      {"methods",
       "accuracy/cheapest.json",
       {"| problem | error 0.01 | error 1e-06 |", "| P | heun, fixed: 100 | – |"}},
      {"steps",
       "accuracy/control.json",
       {"| problem | error | best fixed | evaluations | best adaptive | adaptive: evaluations / "
        "fixed | time / fixed | local: evaluations / fixed | time / fixed |",
        "| P | 0.01 | heun | 100 | heun | 0.5 | 0.625 | – | – |"}},
      {"laws",
       "accuracy/laws.json",
       {"| problem | law | error 0.01 | error 1e-06 |",
        "| P | penalties | heun, fixed: 1.2 ms | – |",
        "| P | projection | heun, fixed: 2 ms | heun, adaptive: 5e+02 ms |"}},
      {"counts",
       "stability/stability.json",
       {"| part | scenes | not finite | aborts | outside | guard events | retries | wall stops | "
        "stopped | refused | faults |",
        "| random | 30 | 0 | 0 | 0 | 5 | 6 | 0 | 0 | 0 | 0 |"}},
      {"race",
       "race/race.json",
       {"| dam break | particles | threads | vat [s] | SPlisHSPlasH [s] | ratio | density error | "
        "machine |",
        "| 10k-tait | 10648 | 2 | 2.5 | 10 | 4.12 | 0.25 % | C, 2 cores |"}}};
  for (const auto& [marker, file, table] : fillings) {
    const Results results;
    const std::string empty = with_marker(marker, "");
    const Result<std::string> page = results.fill(empty);
    ASSERT_TRUE(page) << marker << page.errors()[0].message;
    std::string expected = table[0] + "\n|";
    for (auto bars = std::ranges::count(table[0], '|'); bars > 1; --bars) expected += "---|";
    for (std::size_t row = 1; row < table.size(); ++row) expected += '\n' + table[row];
    EXPECT_EQ(page.value(), with_marker(marker, expected + '\n'));
    // Without its result, nothing changes.
    fs::remove(results.file(file));
    const std::string command = std::string(file).substr(0, std::string(file).find('/'));
    const Result<std::string> failed = results.fill(empty);
    ASSERT_FALSE(failed) << marker;
    EXPECT_THAT(failed.errors()[0].message, HasSubstr("./vat bench " + command + " writes it"));
    EXPECT_EQ(read_file(results.file("page/page.md")), empty);
  }
}

TEST(BenchDocument, CopiesItsPicturesOnly) {
  const Results results;
  const std::string text = "![P](figures/P-time.svg) ![A](web/a.webp)\n";
  EXPECT_EQ(results.fill(text).value(), text);
  EXPECT_EQ(read_file(results.file("page/figures/P-time.svg")), "<svg></svg>");
  EXPECT_FALSE(fs::exists(results.file("page/web/a.webp")));
}

TEST(BenchDocument, TablesOfReliabilityHaveTheFiguresOfTheirResults) {
  const Json recovery = Json::parse(R"([{"particles": 400, "kills": 2, "ticks per second": 50,
    "written [GB/day]": 17.25, "median recovery [s]": 1.5, "longest recovery [s]": 2.5,
    "cpu": "C", "cores": 2}])");
  EXPECT_THAT(to_markdown(bench::recovery_table(recovery)),
              HasSubstr("| 400 | 2 | 50 | 17.2 | 1.5 | 2.5 | C, 2 cores |"));
  const Json faults = Json::parse(R"([{"measure": "lost commands", "value": 0, "bound": "0",
    "cpu": "C", "cores": 2}])");
  EXPECT_THAT(to_markdown(bench::faults_table(faults)),
              HasSubstr("| lost commands | 0 | 0 | C, 2 cores |"));
}

TEST(BenchDocument, TableOfDevicesComparesWithMostThreadsOfTheCpu) {
  const Json speed = Json::parse(R"([
    {"case": "a", "particles": 10, "threads": 1, "instruction set": "avx2", "ms per step": 9,
     "wall s per simulated s": 9, "cpu": "C", "cores": 2},
    {"case": "a", "particles": 10, "threads": 2, "instruction set": "avx2", "ms per step": 5,
     "wall s per simulated s": 5, "cpu": "C", "cores": 2},
    {"case": "a", "particles": 10, "threads": 0, "instruction set": "opencl:0", "ms per step": 8,
     "wall s per simulated s": 15, "cpu": "C", "cores": 2},
    {"case": "b", "particles": 10, "threads": 1, "instruction set": "avx2", "ms per step": 9,
     "wall s per simulated s": 9, "cpu": "C", "cores": 2}])");
  const std::string table = to_markdown(bench::devices_table(speed));
  EXPECT_THAT(table, HasSubstr("| a | 10 | opencl:0 | 8 | 2 | 5 | 0.333 | C, 2 cores |"));
  EXPECT_THAT(table, testing::Not(HasSubstr("| b |")));
}

TEST(BenchDocument, TableOfCasesOnADeviceHasTheClosestMetricAndTheReasons) {
  const Json rows = Json::parse(R"([
    {"case": "a", "metric": "near", "error": 0.02, "error of the CPU": 0.01, "must be": "2 +- 0.1",
     "share of tolerance": 0.2, "passed": true, "refused": ""},
    {"case": "a", "metric": "nearer", "error": 0.3, "error of the CPU": 0.25, "must be": "<= 1",
     "share of tolerance": 0.3, "passed": true, "refused": ""},
    {"case": "a", "metric": "other", "error": null, "error of the CPU": null, "must be": "<= 1",
     "share of tolerance": null, "passed": null, "refused": "/kernel"},
    {"case": "b", "metric": "refused", "error": null, "error of the CPU": null, "must be": "<= 1",
     "share of tolerance": null, "passed": null, "refused": "/periodic"}])");
  const std::string table = to_markdown(bench::device_cases_table(rows));
  EXPECT_THAT(table, HasSubstr("| a | 2 of 3 | nearer | 0.3 | 0.25 | <= 1 | /kernel |"));
  EXPECT_THAT(table, HasSubstr("| b | 0 of 1 | – | – | – | – | /periodic |"));
}

// Each marker is on one page, which has no other markers.
TEST(BenchDocument, PagesHaveEveryMarkerFigureAndCase) {
  std::set<std::string> found;
  for (const char* name :
       {"core/ACCURACY.md", "core/device/DEVICE.md", "README.md", "server/RELIABILITY.md"}) {
    const std::string page = read_file(fs::path(VAT_SOURCE_DIR) / name);
    std::map<std::string, std::string> contents;
    for (const std::string& marker : document_markers()) {
      if (has_marker(page, marker)) contents[marker] = "";
      if (has_marker(page, marker)) found.insert(marker);
    }
    const Result<std::string> filled = fill_markers(page, contents);
    EXPECT_TRUE(filled) << name << filled.errors()[0].path << ' ' << filled.errors()[0].message;
  }
  const std::vector<std::string> markers = document_markers();
  EXPECT_EQ(found, std::set<std::string>(markers.begin(), markers.end()));
  const std::string page = read_file(kPage);
  EXPECT_GE(pictures_of(page).size(), 6u);
  constexpr std::uintmax_t kLargest = 160'000;  // bytes
  for (const std::string& picture : pictures_of(page)) {
    const fs::path file = kPage.parent_path() / picture;
    ASSERT_TRUE(fs::exists(file)) << picture;
    EXPECT_LE(fs::file_size(file), kLargest) << picture;
  }
  for (const validation::Case& one : validation::all_cases()) {
    EXPECT_THAT(page, HasSubstr("\n| " + one.name + " | " + one.title + " |"));
  }
}

TEST(BenchDocument, ShareOfTheToleranceIsOneAtItsEnd) {
  using namespace validation;
  const auto share = [](Real reference, Real measured, Tolerance tolerance) {
    return share_of_tolerance({"m", reference, measured, std::move(tolerance)});
  };
  EXPECT_EQ(share(2, 2.5, within(0.5, "")), 1);
  EXPECT_EQ(share(-2, -3, within_relative(0.5, "")), 1);
  EXPECT_EQ(share(4, 1, at_most("")), 0.25);
  EXPECT_EQ(share(4, 16, at_least("")), 0.25);
  EXPECT_TRUE(std::isnan(share(1, 1, within(0, ""))));
  EXPECT_TRUE(std::isnan(share(1, 2, reported(""))));
}

}  // namespace
}  // namespace vat::bench::bench_document_test
