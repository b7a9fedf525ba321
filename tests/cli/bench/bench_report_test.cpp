#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <stdexcept>
#include <utility>

#include "protocol/json/json_reader.h"
#include "tests/bench/report/plot.h"
#include "tests/bench/report/table.h"
#include "tests/bench/validate/validate.h"
#include "tests/cli/program.h"
#include "tests/cli/readers.h"
#include "tests/validation/order.h"

namespace vat::bench::bench_report_test {
namespace {

using test::read_file;
using test::TemporaryFolder;
using testing::HasSubstr;

constexpr Real kNan = std::numeric_limits<Real>::quiet_NaN();

Table small_table() {
  return {{"name", "value", "count", "good"},
          {{std::string("a|b, \"c\""), 0.1, std::uint64_t{7}, true},
           {std::string(), kNan, std::uint64_t{0}, false}}};
}

TEST(BenchTable, MarkdownIsForReaders) {
  EXPECT_EQ(to_markdown(small_table()),
            "| name | value | count | good |\n"
            "|---|---|---|---|\n"
            "| a\\|b, \"c\" | 0.1 | 7 | yes |\n"
            "|  | - | 0 | no |\n");
}

TEST(BenchTable, CsvKeepsAllDigits) {
  Table table = small_table();
  table.rows[0][1] = 1.0 / 3;
  EXPECT_EQ(to_csv(table),
            "name,value,count,good\n"
            "\"a|b, \"\"c\"\"\",0.3333333333333333,7,true\n"
            ",,0,false\n");
}

TEST(BenchTable, JsonHasOneObjectARow) {
  const Json rows = Json::parse(to_json(small_table()));
  EXPECT_EQ(rows, Json::parse(R"([{"name": "a|b, \"c\"", "value": 0.1, "count": 7, "good": true},
                                  {"name": "", "value": null, "count": 0, "good": false}])"));
}

TEST(BenchTable, FolderIsCreatedOrNamedInTheError) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_table(small_table(), folder.path() / "a" / "b", "t", "# Title"));
  EXPECT_THAT(read_file(folder.file("a/b/t.md")), testing::StartsWith("# Title\n\n| name"));
  const Status failed = write_table(small_table(), folder.path() / "a/b/t.md" / "c", "t", "");
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.errors()[0].path, folder.file("a/b/t.md/c"));
}

LogPlot small_plot() {
  return {.title = "It's a plot",
          .x_label = "x [s]",
          .y_label = "y",
          .series = {{.label = "front", .points = {{1, 0.5}, {2, 0}}, .broad = true},
                     {.label = "none", .points = {{kNan, 1}}},
                     {.label = "line", .points = {{3, 4}}, .colour = 8, .dash = 1}}};
}

TEST(BenchPlot, DataOmitsValuesWithoutLogarithm) {
  EXPECT_EQ(plot_data(small_plot()), "# front\n1 0.5\n\n\n# none\nNaN NaN\n\n\n# line\n3 4\n");
}

TEST(BenchPlot, ScriptDrawsEverySeries) {
  const std::string script = plot_script(small_plot(), "small");
  for (const char* line :
       {"set output 'small.svg'\n", "set title 'It''s a plot'\n", "set xlabel 'x [s]'\n",
        "set ylabel 'y'\n", "set logscale xy\n",
        "plot 'small.dat' index 0 with lines linewidth 9 linecolor rgb '#dddddd' title 'front', ",
        " 'small.dat' index 1 with linespoints linewidth 2 linecolor rgb '#d55e00' dashtype 1 ",
        " 'small.dat' index 2 with linespoints linewidth 2 linecolor rgb '#e69f00' dashtype 2 "
        "pointtype 7 pointsize 0.6 title 'line'\n"}) {
    EXPECT_THAT(script, HasSubstr(line));
  }
}

TEST(BenchPlot, GridHasOneFieldAPair) {
  const GridPlot grid{.title = "t",
                      .x_label = "x",
                      .y_label = "y",
                      .value_label = "v",
                      .x_names = {"a", "b"},
                      .y_names = {"c"},
                      .values = {{0.5, kNan}},
                      .min = 0,
                      .max = 2};
  EXPECT_EQ(plot_data(grid), "0 0 0.5\n1 0 NaN\n");
  const std::string script = plot_script(grid, "g");
  for (const char* line : {"set xtics ('a' 0, 'b' 1)\n", "set ytics ('c' 0)\n",
                           "set xrange [-0.5:1.5]\n", "set cbrange [0:2]\n", "set cblabel 'v'\n",
                           "plot 'g.dat' using 1:2:(0.5):(0.5):3 with boxxyerror"}) {
    EXPECT_THAT(script, HasSubstr(line));
  }
}

TEST(BenchPlot, NothingToDrawIsAnError) {
  const TemporaryFolder folder;
  const Status done = write_plot(LogPlot{}, folder.path(), "empty");
  ASSERT_FALSE(done);
  EXPECT_EQ(done.errors()[0].message, "there are no points to draw");
}

/// Hides the programs of the machine during its lifetime.
class EmptyPath {
 public:
  EmptyPath() {
    if (const char* path = std::getenv("PATH")) old_ = path;
    setenv("PATH", "/nowhere", 1);
  }
  ~EmptyPath() { setenv("PATH", old_.c_str(), 1); }
  EmptyPath(const EmptyPath&) = delete;
  EmptyPath& operator=(const EmptyPath&) = delete;

 private:
  std::string old_;
};

TEST(BenchPlot, MissingGnuplotIsExplained) {
  const EmptyPath hidden;
  const Status found = find_gnuplot();
  ASSERT_FALSE(found);
  EXPECT_THAT(found.errors()[0].message, HasSubstr("./vat packages bench installs it"));
}

TEST(BenchPlot, PictureIsDrawnIfGnuplotIsInstalled) {
  ASSERT_TRUE(find_gnuplot());
  const TemporaryFolder folder;
  const Status done = write_plot(small_plot(), folder.path(), "small");
  ASSERT_TRUE(done) << done.errors()[0].message;
  EXPECT_THAT(folder.names(), testing::ElementsAre("small.dat", "small.gnuplot", "small.svg"));
  EXPECT_THAT(read_file(folder.file("small.svg")), HasSubstr("</svg>"));
}

validation::Case case_with(const std::string& name, Real measured) {
  return {name, "made up", "none", {}, [measured](validation::Sheet& sheet) {
            sheet.add({.metric = "number",
                       .reference = 1,
                       .measured = measured,
                       .tolerance = validation::within(0.1, "nobody"),
                       .state_hash = 0,
                       .seconds = 0});
          }};
}

int exit_code_of(const std::vector<validation::Case>& cases) {
  const TemporaryFolder folder;
  Options options;
  options.output = folder.file("out");
  return validate(options, cases);
}

TEST(BenchValidate, ExitsWithOneIfARowFails) {
  EXPECT_EQ(exit_code_of({case_with("GOOD", 1.05)}), 0);
  EXPECT_EQ(exit_code_of({case_with("GOOD", 1.05), case_with("BAD", 1.2)}), 1);
  EXPECT_EQ(exit_code_of({case_with("NAN", kNan)}), 1);
}

TEST(BenchValidate, ExitsWithOneIfACaseCannotMeasure) {
  const validation::Case broken{"BROKEN", "", "none", {}, [](validation::Sheet&) {
                                  throw std::runtime_error("no such body");
                                }};
  const validation::Case silent{"SILENT", "", "none", {}, [](validation::Sheet&) {}};
  EXPECT_EQ(exit_code_of({broken}), 1);
  EXPECT_EQ(exit_code_of({silent}), 1);
}

/// Adds the position after ten steps, with a tolerance [m].
void add_position(validation::Sheet& sheet, const char* metric, StepControl control, Real tolerance,
                  bool is_held = false) {
  Scene scene =
      validation::with_method(validation::load_scene("DEF-1"), IntegratorId::velocity_verlet, 1e-3);
  scene.numerics.control = control;
  validation::Run run = sheet.start(scene);
  if (is_held) {
    ASSERT_TRUE(run.simulation().grab_start(1, run.body().id, 1, Vec3::Zero()).ok());
  }
  run.advance_to(0.01);
  sheet.add(metric, 1.5, run.body().positions[1].x(), validation::within(tolerance, "nobody"), run);
}

/// A case with one row on a device. The device has fixed steps of solids only, and no grabs.
validation::Case case_on_device(Real tolerance) {
  return {"MIXED", "made up", "none", {}, [tolerance](validation::Sheet& sheet) {
            sheet.add({.metric = "no run"});
            add_position(sheet, "fixed", StepControl::fixed, tolerance);
            add_position(sheet, "adaptive", StepControl::adaptive, 1);
            add_position(sheet, "held", StepControl::fixed, 1, true);
          }};
}

TEST(BenchValidate, ComparesTheRowsOnADeviceThatItSupportsWithTheCpu) {
  const TemporaryFolder folder;
  Options options;
  options.output = folder.file("out");
  const DeviceChoice device = parse_device("opencl").value();
  EXPECT_EQ(validate(options, {case_on_device(1)}, device), 0);
  const test::Table table = test::read_csv(folder.file("out/device.csv"));
  const std::pair<const char*, const char*> expected[] = {{"no run", "no steps"},
                                                          {"fixed", ""},
                                                          {"adaptive", "/numerics/control"},
                                                          {"held", "the CPU took 10 of 10 steps"}};
  ASSERT_EQ(table.rows.size(), std::size(expected));
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const auto& [metric, refused] = expected[row];
    EXPECT_EQ(table.text(row, "metric"), metric);
    EXPECT_EQ(table.text(row, "refused"), refused);
    const bool is_on_device = metric == std::string("fixed");
    EXPECT_EQ(table.text(row, "passed"), is_on_device ? "true" : "");
    EXPECT_EQ(table.text(row, "error of the CPU").empty(), !is_on_device);
  }
  constexpr double kRounding = 1e-13;  // of ten steps in double precision [m]
  EXPECT_GT(table.number(1, "error"), 1e-3);
  EXPECT_NEAR(table.number(1, "error"), table.number(1, "error of the CPU"), kRounding);
  EXPECT_EQ(validate(options, {case_on_device(1e-6)}, device), 1);
}

TEST(BenchValidate, TolerancesHaveTheirSides) {
  const auto passes = [](Real measured, const validation::Tolerance& tolerance) {
    return validation::Row{.metric = "",
                           .reference = 10,
                           .measured = measured,
                           .tolerance = tolerance,
                           .state_hash = 0,
                           .seconds = 0}
        .passed();
  };
  EXPECT_TRUE(passes(10.4, validation::within(0.5, "")));
  EXPECT_FALSE(passes(9.4, validation::within(0.5, "")));
  EXPECT_TRUE(passes(9.6, validation::within_relative(0.05, "")));
  EXPECT_FALSE(passes(10.6, validation::within_relative(0.05, "")));
  EXPECT_TRUE(passes(-3, validation::at_most("")));
  EXPECT_FALSE(passes(10.1, validation::at_most("")));
  EXPECT_TRUE(passes(11, validation::at_least("")));
  EXPECT_FALSE(passes(9.9, validation::at_least("")));
  EXPECT_FALSE(passes(kNan, validation::at_most("")));
}

TEST(BenchOrder, OrderAndFrequencyOfKnownData) {
  const std::vector<Real> sizes = {0.4, 0.2, 0.1};
  std::vector<Real> errors;
  for (const Real size : sizes) errors.push_back(3 * size * size);
  EXPECT_NEAR(validation::observed_order(sizes, errors), 2, 1e-12);
  std::vector<Real> samples;
  for (int i = 0; i < 4000; ++i) {
    samples.push_back(std::sin(12.5 * 1e-3 * i + 0.3));
  }
  EXPECT_NEAR(validation::fitted_frequency(samples, 1e-3), 12.5, 1e-6);
  // A second frequency at a distance of ten periods of the record hardly moves the peak.
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i] += 0.1 * std::sin(40 * 1e-3 * static_cast<Real>(i));
  }
  EXPECT_NEAR(validation::spectral_frequency(samples, 1e-3, 12), 12.5, 1e-3);
}

}  // namespace
}  // namespace vat::bench::bench_report_test
