#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "core/support/result.h"
#include "core/types.h"

/// Plots by gnuplot. NAME.dat and NAME.gnuplot next to NAME.svg allow drawing it again.
namespace vat::bench {

/// Points of one line. Points that are not positive and finite are omitted.
struct Series {
  std::string label;
  std::vector<std::array<Real, 2>> points;
  std::size_t colour = 0;  ///< index in a short list, repeated after its end
  std::size_t dash = 0;    ///< 0: solid
  bool broad = false;      ///< a pale band below the other lines, for example a Pareto front
};

/// Lines with points on two logarithmic axes.
struct LogPlot {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<Series> series;
  std::string number_format = "%.0e";  ///< of both axes, in gnuplot's format
};

/// A number for each pair of two lists of names, drawn as coloured fields.
struct GridPlot {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::string value_label;
  std::vector<std::string> x_names;
  std::vector<std::string> y_names;
  std::vector<std::vector<Real>> values;  ///< by y, then x; non-finite fields are empty
  Real min = 0;                           ///< of the colour scale
  Real max = 1;
};

/// Fails with advice if gnuplot is missing.
Status find_gnuplot();

/// Returns whether a point can be drawn on logarithmic axes.
bool can_be_drawn(const std::array<Real, 2>& point);
/// Returns whether at least one point can be drawn.
bool can_be_drawn(const LogPlot& plot);

/// Writes FOLDER/NAME.dat, .gnuplot and .svg. Fails if gnuplot fails or no point can be drawn.
Status write_plot(const LogPlot& plot, const std::filesystem::path& folder,
                  const std::string& name);
Status write_plot(const GridPlot& plot, const std::filesystem::path& folder,
                  const std::string& name);

/// Return the contents of the files.
std::string plot_data(const LogPlot& plot);
std::string plot_data(const GridPlot& plot);
std::string plot_script(const LogPlot& plot, const std::string& name);
std::string plot_script(const GridPlot& plot, const std::string& name);

}  // namespace vat::bench
