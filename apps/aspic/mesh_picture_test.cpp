#include "aspic/mesh_picture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "aspic/png_test.h"
#include "base/error.h"
#include "io/external_program.h"
#include "io/folder_test.h"
#include "mesh/generators.h"
#include "mesh/surface.h"

namespace aspic::cli {
namespace {

using testing::HasSubstr;

using Refusals = FolderTest;

class MeshPictures : public FolderTest {
 protected:
  void SetUp() override {
    for (const char* name : {"chromium", "chromium-browser", "google-chrome"}) {
      try {
        find_program(name, {}, "");
        return;
      } catch (const InvalidInput&) {
      }
    }
    GTEST_SKIP() << "there is no Chromium";
  }
};

TriMesh beam() { return boundary_surface(make_box({}, {{2, 0.5, 0.5}}, {16, 4, 4})).surface; }

// View from the front: x to the right, z upward.
MeshPicture from_the_front(std::vector<ShadedSurface> panels) {
  MeshPicture picture{.title = "", .panels = std::move(panels), .eye = {{0, -1, 0}}, .wires = Wires::none};
  picture.size = {400, 300};
  return picture;
}

bool is_white(const Pixel& p) { return p == Pixel{255, 255, 255}; }

// Fraction of the rectangle that is not white.
double covered(const Image& image, double left, double right, double top, double bottom) {
  size_t found = 0, count = 0;
  for (auto y = static_cast<unsigned>(top * image.height); y < static_cast<unsigned>(bottom * image.height); ++y)
    for (auto x = static_cast<unsigned>(left * image.width); x < static_cast<unsigned>(right * image.width); ++x)
      ++count, found += !is_white(image.at(x, y));
  return static_cast<double>(found) / static_cast<double>(count);
}

bool is_gray(const Pixel& p) { return std::max({p[0], p[1], p[2]}) - std::min({p[0], p[1], p[2]}) < 12; }

TEST_F(MeshPictures, PanelsAreInOneRowWithCaptions) {
  MeshPicture picture{.title = "A beam & its <b>shape</b>", .panels = {{"at rest", beam()}, {"bent", beam()}}};
  for (Vec3d& x : picture.panels[1].surface.vertices) x[2] -= 0.15 * x[0] * x[0];
  MeshPicture bare = picture;
  bare.title = bare.panels[0].caption = bare.panels[1].caption = "";
  ASSERT_TRUE(draw({{folder / "beams.png", picture}, {folder / "bare.png", bare}}));
  const Image image = read_png(folder / "beams.png"), without = read_png(folder / "bare.png");
  EXPECT_EQ(image.width, 1600u);
  EXPECT_LE(image.height, 960u);
  EXPECT_LT(without.height, image.height);
  EXPECT_GT(covered(image, 0, 0.5, 0.2, 0.8), 0.2);
  EXPECT_GT(covered(image, 0.5, 1, 0.2, 0.8), 0.2);
  EXPECT_GT(covered(image, 0.3, 0.7, 0, 56.0 / image.height), 0.01);           // the title
  EXPECT_GT(covered(image, 0.2, 0.3, 1 - 56.0 / image.height, 1), 0.01);       // a caption
  EXPECT_GT(std::set(image.pixels.begin(), image.pixels.end()).size(), 100u);  // shading, not a flat fill
}

TEST_F(MeshPictures, PanelsHaveOneScale) {
  TriMesh small = beam();
  for (Vec3d& x : small.vertices) x = 0.5 * x;
  ASSERT_TRUE(draw({{folder / "sizes.png", from_the_front({{"", beam()}, {"", small}})}}));
  const Image image = read_png(folder / "sizes.png");
  EXPECT_NEAR(covered(image, 0, 0.5, 0, 1) / covered(image, 0.5, 1, 0, 1), 4, 0.1);
}

TEST_F(MeshPictures, ColorsSpanSmallestToLargestValue) {
  ShadedSurface per_vertex{"", beam()}, per_triangle{"", beam()};
  for (const Vec3d& x : per_vertex.surface.vertices) per_vertex.values.push_back(x[0]);
  for (const Triangle& t : per_triangle.surface.triangles)
    per_triangle.values.push_back(per_triangle.surface.vertices[t[0]][0] < 1 ? 0 : 2);
  MeshPicture picture = from_the_front({per_vertex, per_triangle});
  picture.value_label = "x [m]";
  ASSERT_TRUE(draw({{folder / "values.png", picture}}));
  const Image image = read_png(folder / "values.png");
  std::vector<Pixel> row;  // through the middle of the beams
  for (unsigned x = 0; x < image.width; ++x) row.push_back(image.at(x, image.height / 2));
  const auto purple = [](const Pixel& p) { return p[2] > p[1] && p[0] > p[1]; };
  const auto green = [](const Pixel& p) { return p[1] > p[0] && p[1] > p[2]; };
  const auto yellow = [](const Pixel& p) { return p[0] > 150 && p[1] > 130 && p[2] < 100; };
  const auto half = row.begin() + 300;  // two panels of a little more than 300 pixels, and the color bar
  EXPECT_TRUE(purple(row[20])) << "the least value, on the left";
  EXPECT_GT(std::count_if(row.begin(), half, green), 50) << "those between";
  EXPECT_GT(std::count_if(row.begin(), half, yellow), 10) << "the largest";
  EXPECT_LT(std::count_if(half, half + 300, green), 5) << "values of triangles end at their edges";
  EXPECT_GT(std::count_if(half, half + 300, yellow), 100);
  EXPECT_GT(covered(image, 0.85, 1, 0, 1), 0.03) << "the color bar";
}

TEST_F(MeshPictures, MissingValuesAreGrayNonFiniteTrianglesOmitted) {
  ShadedSurface panel{"", beam()};
  for (const Vec3d& x : panel.surface.vertices) panel.values.push_back(x[0] < 1 ? NAN : 1.0);
  panel.values.back() = 2;
  MeshPicture picture = from_the_front({panel, panel});
  for (Vec3d& x : picture.panels[1].surface.vertices)
    if (x[0] > 1.2) x[2] = x[0] > 1.6 ? INFINITY : 1e300;
  ASSERT_TRUE(draw({{folder / "gaps.png", picture}}));
  const Image image = read_png(folder / "gaps.png");
  const auto is_gray_ink = [](const Pixel& p) { return is_gray(p) && p[0] < 230; };
  size_t gray = 0, colored = 0;
  for (unsigned x = 10; x < 300; ++x) {
    const Pixel& p = image.at(x, image.height / 2);
    gray += is_gray_ink(p), colored += !is_gray(p);
  }
  EXPECT_GT(gray, 100u);
  EXPECT_GT(colored, 100u);
}

TEST_F(MeshPictures, DrawingStopsWhenAsked) {
  EXPECT_FALSE(draw({{folder / "none.png", from_the_front({{"", beam()}})}}, StopToken([] { return true; })));
  EXPECT_FALSE(std::filesystem::exists(folder / "none.png"));
}

TEST_F(MeshPictures, SurfacesWithoutSizeAreRefusedWithoutFiles) {
  const TemporaryFolder temporary;  // short path, because the browser creates a socket there
  ::setenv("TMPDIR", temporary.path().c_str(), 1);
  const TriMesh point{{{}, {}, {}}, {{0, 1, 2}}};
  const std::string message = message_of([&] { draw({{folder / "none.png", from_the_front({{"", point}})}}); });
  ::unsetenv("TMPDIR");
  EXPECT_THAT(message, HasSubstr("no size"));
  EXPECT_TRUE(std::filesystem::is_empty(temporary.path()));
}

TEST_F(Refusals, OfMeshesWithoutAnythingToDraw) {
  const auto refused = [&](const MeshPicture& picture, const char* name = "none.png") {
    return message_of([&] { draw({{folder / name, picture}}); });
  };
  EXPECT_THAT(refused({}), HasSubstr("no surface"));
  EXPECT_THAT(refused(from_the_front({{"empty", {}}})), HasSubstr("'empty' has no finite triangle"));
  TriMesh burst = beam();
  for (Vec3d& x : burst.vertices) x[0] = NAN;
  EXPECT_THAT(refused(from_the_front({{"burst", burst}})), HasSubstr("'burst' has no finite triangle"));
  EXPECT_THAT(refused(from_the_front({{"", beam()}}), "beam.svg"), HasSubstr("must be .png, not '.svg'"));
}

TEST_F(Refusals, NameThePackageOfTheMissingBrowser) {
  const char* const path = ::getenv("PATH");
  const std::string before = path ? path : "";
  ::setenv("PATH", folder.path().c_str(), 1);
  const std::string message = message_of([&] { draw({{folder / "none.png", from_the_front({{"", beam()}})}}); });
  ::setenv("PATH", before.c_str(), 1);
  EXPECT_THAT(message, HasSubstr("apt-get install chromium"));
}

}  // namespace
}  // namespace aspic::cli
