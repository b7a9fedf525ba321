#include "server/cli/tune/tune_report.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace vat {

namespace {

constexpr char kDot = '.';
constexpr char kOwn = '*';

std::string digits(double value) {
  std::ostringstream text;
  text << std::setprecision(3) << value;
  return text.str();
}

/// Logarithmic axis of a plot, with whole numbers of cells.
class LogAxis {
 public:
  LogAxis(double least, double greatest, int cells)
      : low_(std::log10(least)), high_(std::log10(greatest)), cells_(cells) {
    constexpr double kLeastRange = 0.05;
    if (high_ - low_ < kLeastRange) high_ = low_ + kLeastRange;
  }
  int cell_of(double value) const {
    const double share = (std::log10(value) - low_) / (high_ - low_);
    return std::clamp(static_cast<int>(std::lround(share * (cells_ - 1))), 0, cells_ - 1);
  }
  std::string label(int cell) const {
    return digits(std::pow(10.0, low_ + (high_ - low_) * cell / (cells_ - 1)));
  }

 private:
  double low_;
  double high_;
  int cells_;
};

std::string row_of(char label, bool is_own, const tune::Point& point, const tune::Outcome& outcome,
                   const std::string& numerics) {
  std::uint64_t steps = 0;
  std::uint64_t iterations = 0;
  for (const tune::Segment& segment : outcome.segments) {
    steps += segment.steps;
    iterations += segment.iterations;
  }
  const double per_step =
      steps > 0 ? static_cast<double>(iterations) / static_cast<double>(steps) : 0;
  std::ostringstream row;
  constexpr int kLabelWidth = 2;
  constexpr int kWidth = 10;
  row << std::setw(kLabelWidth) << label << (is_own ? kOwn : ' ') << std::right;
  for (const std::string& cell : {digits(point.error), digits(point.seconds), digits(point.slowest),
                                  std::to_string(steps), digits(per_step)}) {
    row << std::setw(kWidth) << cell;
  }
  row << "  " << numerics << '\n';
  return row.str();
}

}  // namespace

char TuneReport::label(std::size_t candidate) const {
  constexpr std::size_t kLetters = 26;
  const auto found = std::ranges::find(front, candidate, &tune::Point::candidate);
  const auto at = static_cast<std::size_t>(found - front.begin());
  if (found != front.end() && at < kLetters) return static_cast<char>('a' + at);
  return candidate == set.own ? kOwn : kDot;
}

std::string TuneReport::table() const {
  std::string text = "        error   s per s   slowest     steps iterations  numerics\n";
  std::vector<tune::Point> rows = front;
  for (const tune::Point& point : points) {
    const bool is_listed =
        std::ranges::find(front, point.candidate, &tune::Point::candidate) != front.end();
    if (point.candidate == set.own && !is_listed) rows.push_back(point);
  }
  for (const tune::Point& point : rows) {
    const char mark = label(point.candidate);
    text += row_of(mark == kOwn ? ' ' : mark, point.candidate == set.own, point,
                   outcomes[point.candidate],
                   describe(set.candidates[point.candidate], set.has_liquid));
  }
  return text;
}

std::string TuneReport::plot() const {
  if (points.empty()) return {};
  constexpr int kColumns = 64;
  constexpr int kRows = 16;
  constexpr int kLabelWidth = 9;
  const auto [fast, slow] = std::ranges::minmax(points, {}, &tune::Point::seconds);
  const auto [good, bad] = std::ranges::minmax(points, {}, &tune::Point::error);
  const LogAxis times(fast.seconds, slow.seconds, kColumns);
  const LogAxis errors(good.error, bad.error, kRows);
  std::vector<std::string> cells(kRows, std::string(kColumns, ' '));
  const auto mark = [&](const tune::Point& point) {
    char& cell = cells[static_cast<std::size_t>(errors.cell_of(point.error))]
                      [static_cast<std::size_t>(times.cell_of(point.seconds))];
    const char wanted = label(point.candidate);
    if (cell == ' ' || cell == kDot) cell = wanted;
  };
  for (const tune::Point& point : front) mark(point);
  for (const tune::Point& point : points) mark(point);
  std::ostringstream text;
  for (int row = kRows - 1; row >= 0; --row) {
    const bool is_labelled = row % 5 == 0;
    text << std::setw(kLabelWidth) << (is_labelled ? errors.label(row) : "") << " |"
         << cells[static_cast<std::size_t>(row)] << '\n';
  }
  text << std::setw(kLabelWidth) << "error"
       << " +" << std::string(kColumns, '-') << '\n';
  const std::string begin = times.label(0);
  const std::string end = times.label(kColumns - 1);
  const std::string middle = "computing time per simulated second [s]";
  const auto left = static_cast<int>(kColumns - begin.size() - end.size());
  text << std::string(kLabelWidth + 2, ' ') << begin
       << std::setw((left + static_cast<int>(middle.size())) / 2) << middle
       << std::setw(left - (left + static_cast<int>(middle.size())) / 2 +
                    static_cast<int>(end.size()))
       << end << '\n';
  return text.str();
}

std::string TuneReport::counts() const {
  const auto count = [this](tune::OutcomeKind kind) {
    return std::to_string(std::ranges::count(outcomes, kind, &tune::Outcome::kind));
  };
  std::string text = std::to_string(outcomes.size()) +
                     " candidates: " + count(tune::OutcomeKind::completed) + " completed, " +
                     count(tune::OutcomeKind::dropped) + " dropped early, " +
                     count(tune::OutcomeKind::failed) + " failed";
  const std::string waiting = count(tune::OutcomeKind::waiting);
  return waiting == "0" ? text : text + ", " + waiting + " not completed";
}

}  // namespace vat
