#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "error_of.h"
#include "mien/core/error.h"
#include "mien/picture/color_map.h"
#include "mien/picture/plot.h"
#include "mien/picture/sheet.h"

namespace mien {
namespace {

using test::error_of;
using ::testing::HasSubstr;
using ::testing::Not;

/// Nearly this colour: lines are smoothed.
bool has_pixel(const Picture& picture, std::array<int, 3> rgb) {
  for (std::size_t i = 0; i < picture.rgba.size(); i += 4)
    if (std::abs(picture.rgba[i] - rgb[0]) + std::abs(picture.rgba[i + 1] - rgb[1]) +
            std::abs(picture.rgba[i + 2] - rgb[2]) <
        6)
      return true;
  return false;
}

TEST(ColorMap, EndsAndNames) {
  EXPECT_THAT(error_of([] { color_map_of_name("jet"); }), HasSubstr("heat, viridis or cool-warm"));
  EXPECT_EQ(color_map_of_name("cool-warm"), ColorMap::cool_warm);
  for (const ColorMap map : {ColorMap::heat, ColorMap::viridis, ColorMap::cool_warm}) {
    EXPECT_EQ(map_color(map, -3), map_color(map, 0));
    EXPECT_EQ(map_color(map, 7), map_color(map, 1));
    EXPECT_NE(map_color(map, 0), map_color(map, 1));
    EXPECT_EQ(map_color(map, std::nan("")), (Color{0.6f, 0.6f, 0.6f}));
  }
}

TEST(ContactSheet, InvalidInputs) {
  EXPECT_THAT(error_of([] { contact_sheet({}); }), HasSubstr("sheet: has no pictures"));
  const std::vector<SheetCell> wide(20, SheetCell{"", blank_picture(1000, 2), ""});
  EXPECT_THAT(error_of([&] { contact_sheet(wide, {"", "", 20}); }), HasSubstr("sides from 1 to 16384"));
}

TEST(ContactSheet, HoldsEveryPictureWhole) {
  const Picture sheet = contact_sheet({{"a", blank_picture(100, 80, {1, 0, 0}), ""},
                                       {"b", blank_picture(60, 80, {0, 1, 0}), "caption"},
                                       {"\xff not UTF-8", blank_picture(100, 20, {0, 0, 1}), ""}},
                                      {"title", "footer", 2});
  EXPECT_GT(sheet.width, 200);
  EXPECT_LT(sheet.width, 240);
  EXPECT_GT(sheet.height, 160);
  int red = 0, green = 0, blue = 0;
  for (std::size_t i = 0; i < sheet.rgba.size(); i += 4) {
    red += sheet.rgba[i] == 255 && sheet.rgba[i + 1] == 0 && sheet.rgba[i + 2] == 0;
    green += sheet.rgba[i] == 0 && sheet.rgba[i + 1] == 255;
    blue += sheet.rgba[i] == 0 && sheet.rgba[i + 2] == 255;
  }
  EXPECT_EQ(red, 8000);
  EXPECT_EQ(green, 4800);
  EXPECT_EQ(blue, 2000);
}

TEST(LinePlot, InvalidInputs) {
  EXPECT_THAT(error_of([] { line_plot({}); }), HasSubstr("plot: has no series"));
  EXPECT_THAT(error_of([] { line_plot({{"jaw", {1, 2}, {1}}}); }), HasSubstr("series jaw: has 2 x and 1 y"));
  EXPECT_THAT(error_of([] {
                line_plot({{"jaw", {NAN}, {1}}});
              }),
              HasSubstr("series jaw: has an x that is not"));
}

TEST(LinePlot, DrawsCurvesInThePalette) {
  PlotOptions options;
  options.title = "jaw & <lip>";
  const std::vector<Series> series{{"source", {0, 1, 2}, {0, 1, NAN}}, {"target", {0, 2}, {1, 0}}};
  const Picture picture = line_plot(series, options);
  EXPECT_EQ(picture.width, 640);
  EXPECT_TRUE(has_pixel(picture, {31, 120, 181}));
  EXPECT_TRUE(has_pixel(picture, {227, 107, 10}));
  const std::string svg = line_plot_svg(series, options);
  EXPECT_THAT(svg, HasSubstr("jaw &amp; &lt;lip&gt;"));
  EXPECT_THAT(svg, HasSubstr(">source</text>"));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

TEST(LinePlot, ConstantEmptyAndHugeValuesAreDrawn) {
  for (const Series& one :
       {Series{"", {1, 1}, {5, 5}}, Series{"", {}, {}}, Series{"", {0, 1}, {NAN, NAN}},
        Series{"", {-1e300, 1e300}, {-1e300, 1e300}}, Series{"", {0, 1e-300}, {0, 1e-300}},
        Series{"", {1e9, 1e9 + 1}, {1e9, 1e9 + 1e-9}}}) {
    PlotOptions options;
    options.zero = false;
    const std::string svg = line_plot_svg({one}, options);
    EXPECT_LT(svg.size(), 100000u);
    EXPECT_THAT(svg, Not(HasSubstr("nan")));
    EXPECT_THAT(svg, Not(HasSubstr("inf")));
  }
}

TEST(BarChart, InvalidInputs) {
  EXPECT_THAT(error_of([] { bar_chart({}, {{"a", {}}}); }), HasSubstr("has no labels"));
  EXPECT_THAT(error_of([] { bar_chart({"a"}, {}); }), HasSubstr("has no groups"));
  EXPECT_THAT(error_of([] { bar_chart({"a"}, {{"g", {1, 2}}}); }), HasSubstr("bars g: have 2 values; 1"));
}

TEST(BarChart, BarsAreAsLongAsTheirValues) {
  const std::string svg = bar_chart_svg({"a", "b"}, {{"only", {2, 1}}});
  const auto width_after = [&](std::size_t from) {
    const std::size_t at = svg.find("width=\"", svg.find("<rect", from)) + 7;
    return std::stod(svg.substr(at));
  };
  const double first = width_after(0), second = width_after(svg.find("<rect") + 1);
  EXPECT_NEAR(first, 2 * second, 0.02);
}

}  // namespace
}  // namespace mien
