#include <algorithm>
#include <array>
#include <cmath>

#include "core/support/check.h"
#include "protocol/files/text.h"
#include "tests/bench/report/plot.h"

namespace vat::bench {

namespace {

/// Colours for colour-blind readers too (M. Okabe, K. Ito, Color Universal Design, 2008).
constexpr std::array<const char*, 7> kColours = {"#d55e00", "#e69f00", "#0072b2", "#009e73",
                                                 "#cc79a7", "#56b4e9", "#000000"};

/// Returns a gnuplot string.
std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'') out += c;
    out += c;
  }
  return out + "'";
}

std::string plot_number(Real value) {
  std::string text;
  append_number(text, value);
  return text;
}

std::string preamble(const std::string& name, const std::string& title, const std::string& x_label,
                     const std::string& y_label) {
  return "set terminal svg size 960,600 dynamic noenhanced background 'white' "
         "font 'sans-serif,14'\n"
         "set output " +
         quoted(name + ".svg") +
         "\n"
         "set title " +
         quoted(title) +
         "\n"
         "set xlabel " +
         quoted(x_label) +
         "\n"
         "set ylabel " +
         quoted(y_label) + "\n";
}

std::string line_style(const Series& series) {
  if (series.broad) return "with lines linewidth 9 linecolor rgb '#dddddd'";
  return "with linespoints linewidth 2 linecolor rgb '" +
         std::string(kColours[series.colour % kColours.size()]) + "' dashtype " +
         std::to_string(series.dash + 1) + " pointtype " + std::to_string(2 * series.dash + 5) +
         " pointsize 0.6";
}

std::string tics(const char* axis, const std::vector<std::string>& names) {
  std::string text = std::string("set ") + axis + "tics (";
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += ", ";
    text += quoted(names[i]) + ' ' + std::to_string(i);
  }
  return text + ")\n";
}

}  // namespace

bool can_be_drawn(const std::array<Real, 2>& point) {
  return std::ranges::all_of(point, [](Real x) { return std::isfinite(x) && x > 0; });
}

bool can_be_drawn(const LogPlot& plot) {
  return std::ranges::any_of(plot.series, [](const Series& series) {
    return std::ranges::any_of(series.points,
                               [](const auto& point) { return can_be_drawn(point); });
  });
}

std::string plot_data(const LogPlot& plot) {
  std::string text;
  for (const Series& series : plot.series) {
    if (!text.empty()) text += "\n\n";
    text += "# " + series.label + '\n';
    bool empty = true;
    for (const std::array<Real, 2>& point : series.points) {
      if (!can_be_drawn(point)) continue;
      text += plot_number(point[0]) + ' ' + plot_number(point[1]) + '\n';
      empty = false;
    }
    if (empty) text += "NaN NaN\n";  // a separate block for gnuplot
  }
  return text;
}

std::string plot_script(const LogPlot& plot, const std::string& name) {
  std::string text = preamble(name, plot.title, plot.x_label, plot.y_label) +
                     "set logscale xy\n"
                     "set format xy " +
                     quoted(plot.number_format) +
                     "\n"
                     "set grid\n"
                     "set key outside right\n"
                     "plot";
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    text += (i > 0 ? ", \\\n  " : " ") + quoted(name + ".dat") + " index " + std::to_string(i) +
            ' ' + line_style(plot.series[i]) + " title " + quoted(plot.series[i].label);
  }
  return text + '\n';
}

std::string plot_data(const GridPlot& plot) {
  VAT_CHECK(plot.values.size() == plot.y_names.size());
  std::string text;
  for (std::size_t y = 0; y < plot.values.size(); ++y) {
    VAT_CHECK(plot.values[y].size() == plot.x_names.size());
    for (std::size_t x = 0; x < plot.values[y].size(); ++x) {
      const Real value = plot.values[y][x];
      text += std::to_string(x) + ' ' + std::to_string(y) + ' ' +
              (std::isfinite(value) ? plot_number(value) : "NaN") + '\n';
    }
  }
  return text;
}

std::string plot_script(const GridPlot& plot, const std::string& name) {
  const std::string file = quoted(name + ".dat");
  return preamble(name, plot.title, plot.x_label, plot.y_label) + tics("x", plot.x_names) +
         tics("y", plot.y_names) +
         "set xrange [-0.5:" + plot_number(static_cast<Real>(plot.x_names.size()) - 0.5) + "]\n" +
         "set yrange [-0.5:" + plot_number(static_cast<Real>(plot.y_names.size()) - 0.5) + "]\n" +
         "set cbrange [" + plot_number(plot.min) + ':' + plot_number(plot.max) + "]\n" +
         "set cblabel " + quoted(plot.value_label) + "\n" +
         "set palette defined (0 '#7f3b08', 0.5 '#f7f7f7', 1 '#2d8a57')\n"
         "set datafile missing 'NaN'\n"
         "plot " +
         file +
         " using 1:2:(0.5):(0.5):3 with boxxyerror fillstyle solid linecolor palette notitle" +
         ", \\\n  " + file + " using 1:2:(sprintf('%.3g', $3)) with labels notitle\n";
}

}  // namespace vat::bench
