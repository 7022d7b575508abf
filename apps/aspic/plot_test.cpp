#include "aspic/plot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <random>

#include "base/error.h"
#include "io/atomic_file.h"
#include "io/folder_test.h"

namespace aspic::cli {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

using Pictures = FolderTest;

// Size in the header of a PNG; {0, 0} if the file is no PNG.
std::pair<unsigned, unsigned> png_size(const fs::path& path) {
  const std::string bytes = read_file(path);
  if (!bytes.starts_with("\x89PNG\r\n\x1a\n") || bytes.substr(12, 4) != "IHDR") return {0, 0};
  const auto big_endian = [&](size_t at) {
    unsigned value = 0;
    for (size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
    return value;
  };
  return {big_endian(16), big_endian(20)};
}

size_t count(const std::string& text, const std::string& what) {
  size_t found = 0;
  for (size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++found;
  return found;
}

bool has(const std::string& text, const std::string& what) { return text.find(what) != std::string::npos; }

Chart convergence() {
  Chart chart{.title = "Order of accuracy of the integrators",
              .x = {"time step h [s]", AxisScale::logarithmic},
              .y = {"error of the position [m]", AxisScale::logarithmic},
              .series = {{"backward Euler", {}, {}, SeriesStyle::line_and_points},
                         {"BDF2", {}, {}, SeriesStyle::line_and_points},
                         {"implicit midpoint", {}, {}, SeriesStyle::line_and_points},
                         {"slope 2", {}, {}, SeriesStyle::dashed, 6}}};
  for (int k = 0; k < 7; ++k) {
    const double h = std::pow(0.5, k + 3);
    for (size_t s = 0; s < 4; ++s) chart.series[s].x.push_back(h);
    chart.series[0].y.push_back(0.2 * h);
    chart.series[1].y.push_back(0.5 * h * h);
    chart.series[2].y.push_back(0.1 * h * h);
    chart.series[3].y.push_back(0.3 * h * h);
  }
  return chart;
}

template <class F>
SampledFunction sampled(double low, double high, int n, F f) {
  SampledFunction result;
  for (int i = 0; i < n; ++i) result.x.push_back(low + (high - low) * i / (n - 1));
  result.y = result.x;
  for (const double y : result.y)
    for (const double x : result.x) result.z.push_back(f(x, y));
  return result;
}
double rosenbrock(double x, double y) { return (1 - x) * (1 - x) + 100 * (y - x * x) * (y - x * x); }
double two_bump(double x, double y) { return x * std::exp(-x * x - y * y); }

TEST_F(Pictures, AChartOnLogarithmicAxesShowsEverySeries) {
  draw(folder / "chart.svg", convergence());
  const std::string svg = read_file(folder / "chart.svg");
  for (const char* text : {"Order of accuracy of the integrators", "time step h [s]", "BDF2", "slope 2"})
    EXPECT_TRUE(has(svg, text)) << text;
  EXPECT_TRUE(svg.ends_with("</svg>\n\n"));
  draw(folder / "chart.png", convergence());
  EXPECT_EQ(png_size(folder / "chart.png"), std::pair(1440u, 880u));
}

TEST_F(Pictures, LinearChartsHaveLinesAndPoints) {
  Chart chart{
      .title = "Energy of a swinging beam",
      .x = {"time [s]"},
      .y = {"energy [J]"},
      .series = {
          {"kinetic"}, {"elastic"}, {"total", {}, {}, SeriesStyle::dashed}, {"measured", {}, {}, SeriesStyle::points}}};
  std::mt19937 random(1);
  for (int i = 0; i < 200; ++i) {
    const double t = 0.01 * i, decay = std::exp(-0.5 * t), k = decay * std::pow(std::sin(4 * t), 2);
    const double y[] = {k, decay - k, decay, k + 0.00002 * (static_cast<double>(random() % 2001) - 1000)};
    for (size_t s = 0; s < 4; ++s)
      if (s < 3 || i % 8 == 0) chart.series[s].x.push_back(t), chart.series[s].y.push_back(y[s]);
  }
  draw(folder / "energy.png", chart);
  EXPECT_EQ(png_size(folder / "energy.png"), std::pair(1440u, 880u));
}

TEST_F(Pictures, TextInTitlesIsNeitherCommandNorMarkup) {
  const std::string text = "it's <b>a_1^2 & \"%s\"</b> `touch pwned` $x @y {/Bold z} \\n \xce\xbc";
  Chart chart = convergence();
  chart.title = text;
  chart.y.label = "ends in '";
  chart.series[1].label = "q'' @y at '''";
  chart.x.label = chart.series[0].label = "'; system('touch pwned'); '\nset output 'pwned";
  const fs::path before = fs::current_path();
  fs::current_path(folder.path());
  draw("special.svg", chart);
  EXPECT_FALSE(fs::exists("pwned"));
  fs::current_path(before);
  const std::string svg = read_file(folder / "special.svg");
  EXPECT_TRUE(has(svg, "it's &lt;b>a_1^2 &amp; \"%s\"&lt;/b> `touch pwned` $x @y {/Bold z} \\n \xce\xbc"));
  EXPECT_TRUE(has(svg, "q'' @y at '''"));
  EXPECT_EQ(count(svg, "<svg"), 1u);
}

TEST_F(Pictures, ValuesThatAreNotFiniteAreGaps) {
  Chart chart{.title = "gap", .x = {"x"}, .y = {"y"}, .series = {{"", {0, 1, 2, 3, 4}, {0, 1, NAN, 1, 0}}}};
  draw(folder / "gap.svg", chart);
  chart.series[0].y[2] = 1;
  draw(folder / "whole.svg", chart);
  const auto pieces = [](const std::string& svg) {  // number of pen-down moves of the curve
    const size_t begin = svg.find("id=\"gnuplot_plot_1\""), end = svg.find("'/></g>", begin);
    return count(svg.substr(begin, end - begin), "M");
  };
  EXPECT_EQ(pieces(read_file(folder / "whole.svg")), 1u);
  EXPECT_EQ(pieces(read_file(folder / "gap.svg")), 2u);
}

TEST_F(Pictures, ChartWithoutNumbersIsAnEmptyFrame) {
  for (const AxisScale scale : {AxisScale::linear, AxisScale::logarithmic}) {
    Chart chart{.title = "nothing",
                .x = {"x", scale},
                .y = {"y", scale},
                .series = {{"undefined", {1, 2}, {NAN, INFINITY}}, {"empty", {}, {}}}};
    draw(folder / "nothing.svg", chart);
    EXPECT_TRUE(has(read_file(folder / "nothing.svg"), "nothing"));
    chart.series.clear();
    draw(folder / "nothing.svg", chart);
    EXPECT_TRUE(has(read_file(folder / "nothing.svg"), "nothing"));
  }
}

TEST_F(Pictures, ContourMapShowsPathAndRejectedTrials) {
  ContourMap map{.title = "Gradient descent on Rosenbrock's function",
                 .function = sampled(-1.5, 1.5, 151, rosenbrock),
                 .paths = {{"gradient descent", {}, {{0.3, 0.9}, {0.1, -0.4}}},
                           {"Newton", {{-0.8, 0.6}, {-0.7, 0.45}, {0.2, -0.3}, {0.4, 0.1}, {0.9, 0.8}, {1, 1}}}},
                 .minimizer = Point2{1, 1}};
  Point2 x = {-0.8, 0.6};
  for (int i = 0; i < 60; ++i) {
    map.paths[0].points.push_back(x);
    const double b = x[1] - x[0] * x[0];
    const Point2 g = {-2 * (1 - x[0]) - 400 * x[0] * b, 200 * b};
    double alpha = 1;
    while (alpha > 1e-9 && !(rosenbrock(x[0] - alpha * g[0], x[1] - alpha * g[1]) <
                             rosenbrock(x[0], x[1]) - 1e-4 * alpha * (g[0] * g[0] + g[1] * g[1])))
      alpha /= 2;
    x = {x[0] - alpha * g[0], x[1] - alpha * g[1]};
  }
  draw(folder / "contours.svg", map);
  const std::string svg = read_file(folder / "contours.svg");
  for (const char* text : {"gradient descent", "rejected trials", "start", "Newton", "minimum"})
    EXPECT_TRUE(has(svg, text)) << text;
  draw(folder / "contours.png", map);
  EXPECT_EQ(png_size(folder / "contours.png"), std::pair(1240u, 1120u));
  ContourMap bumps{.title = "x exp(-x\xc2\xb2 - y\xc2\xb2)",
                   .function = sampled(-2, 2, 121, two_bump),
                   .paths = {},
                   .minimizer = Point2{-std::sqrt(0.5), 0}};
  draw(folder / "bumps.png", bumps);
}

TEST_F(Pictures, AFunctionThatIsNowhereFiniteIsRefused) {
  EXPECT_THROW(
      draw(folder / "none.svg",
           ContourMap{.title = "", .function = sampled(0, 1, 5, [](double, double) { return NAN; }), .paths = {}}),
      InvalidInput);
  EXPECT_FALSE(fs::exists(folder / "none.svg"));
}

TEST_F(Pictures, ASurfaceHasItsModelOverIt) {
  SurfacePlot plot{
      .title = "The quadratic model at (-0.8, 0.6)", .z_label = "f", .function = sampled(-1, 1, 61, rosenbrock)};
  const double x0 = -0.8, y0 = 0.6, b = y0 - x0 * x0;
  const double gx = -2 * (1 - x0) - 400 * x0 * b, gy = 200 * b, xx = 2 - 400 * (y0 - 3 * x0 * x0), xy = -400 * x0,
               yy = 200;
  plot.model = sampled(-1, 1, 61, [&](double x, double y) {
    const double u = x - x0, v = y - y0;
    return rosenbrock(x0, y0) + gx * u + gy * v + 0.5 * (xx * u * u + 2 * xy * u * v + yy * v * v);
  });
  plot.model_label = "quadratic model";
  plot.z_min = -30;
  plot.z_max = 420;
  plot.points = {{"iterate", x0, y0, rosenbrock(x0, y0)}, {"its minimizer", -0.5, 0.1, 10}};
  draw(folder / "surface.png", plot);
  EXPECT_EQ(png_size(folder / "surface.png"), std::pair(1400u, 1120u));
  draw(folder / "bump_surface.png", SurfacePlot{.title = "two bumps", .function = sampled(-2, 2, 61, two_bump)});
}

TEST_F(Pictures, AnotherExtensionIsRefusedByName) {
  EXPECT_THAT(message_of([&] { draw(folder / "chart.jpeg", convergence()); }),
              HasSubstr("a picture must be .svg or .png, not '.jpeg'"));
}

TEST_F(Pictures, WithoutGnuplotTheMessageNamesItsPackage) {
  const char* const path = ::getenv("PATH");
  const std::string before = path ? path : "";
  ::setenv("PATH", folder.path().c_str(), 1);
  const std::string message = message_of([&] { draw(folder / "missing.svg", convergence()); });
  ::setenv("PATH", before.c_str(), 1);
  EXPECT_THAT(message, HasSubstr("gnuplot-nox"));
  EXPECT_FALSE(fs::exists(folder / "missing.svg"));
}

TEST_F(Pictures, TemporaryFilesAreRemoved) {
  const fs::path temporary = folder / "temporary";
  fs::create_directories(temporary);
  ::setenv("TMPDIR", temporary.c_str(), 1);
  draw(folder / "clean.svg", convergence());
  EXPECT_THROW(draw(folder / "none" / "chart.svg", convergence()), InvalidInput);  // no such folder
  ::unsetenv("TMPDIR");
  EXPECT_TRUE(fs::is_empty(temporary));
}

}  // namespace
}  // namespace aspic::cli
