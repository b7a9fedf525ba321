#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "core/support/result.h"
#include "core/types.h"

/// Pictures by gnuplot. Beside NAME.svg lie NAME.dat and NAME.gnuplot, from which anybody can draw
/// it again or differently.
namespace vat::bench {

/// Points of one line. Points that are not positive and finite are left out.
struct Series {
  std::string label;
  std::vector<std::array<Real, 2>> points;
  std::size_t colour = 0;  ///< of a short list, begun anew where it ends
  std::size_t dash = 0;    ///< 0: solid
  bool broad = false;      ///< a pale band below the other lines, such as a Pareto front
};

/// Lines with points over two logarithmic axes.
struct LogPlot {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<Series> series;
  std::string number_format = "%.0e";  ///< of both axes, as gnuplot has it
};

/// A number for each pair of two lists of names, as coloured fields.
struct GridPlot {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::string value_label;
  std::vector<std::string> x_names;
  std::vector<std::string> y_names;
  std::vector<std::vector<Real>> values;  ///< by y, then x; fields that are not finite stay empty
  Real min = 0;                           ///< of the colours
  Real max = 1;
};

/// Fails, and says what to do, where there is no gnuplot.
Status find_gnuplot();

/// True for points that have a place on logarithmic axes.
bool can_be_drawn(const std::array<Real, 2>& point);
/// True where there is at least one.
bool can_be_drawn(const LogPlot& plot);

/// Writes FOLDER/NAME.dat, .gnuplot and .svg. Fails where gnuplot does, or nothing can be drawn.
Status write_plot(const LogPlot& plot, const std::filesystem::path& folder,
                  const std::string& name);
Status write_plot(const GridPlot& plot, const std::filesystem::path& folder,
                  const std::string& name);

/// The files' contents.
std::string plot_data(const LogPlot& plot);
std::string plot_data(const GridPlot& plot);
std::string plot_script(const LogPlot& plot, const std::string& name);
std::string plot_script(const GridPlot& plot, const std::string& name);

}  // namespace vat::bench
