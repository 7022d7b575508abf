#include "io/legacy_vtk.h"

#include <gmock/gmock.h>

#include <cmath>

#include "base/error.h"
#include "io/mesh_examples_test.h"

namespace aspic {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string legacy_error(const std::string& contents) {
  try {
    parse_legacy_vtk(contents, "a.vtk");
  } catch (const InvalidInput& e) {
    return e.what();
  }
  return "no error";
}

std::string with(std::string text, const std::string& from, const std::string& to) {
  const size_t place = text.find(from);
  EXPECT_NE(place, text.npos) << from;
  return text.replace(place, from.size(), to);
}

const Field& named(const std::vector<Field>& fields, const std::string& name) {
  for (const Field& field : fields)
    if (field.name == name) return field;
  throw InvalidInput("no field " + name);
}

TEST(LegacyVtk, AllVariantsHoldTheSameGrid) {
  for (const bool is_binary : {false, true})
    for (const bool has_offsets : {false, true}) {
      const Vtu grid = parse_legacy_vtk(legacy_vtk(is_binary, has_offsets), "a.vtk");
      ASSERT_EQ(grid.mesh.rest.size(), 5u);
      EXPECT_EQ(grid.mesh.rest[4][2], 1);
      EXPECT_THAT(grid.mesh.tets, ElementsAre(Tet{0, 1, 2, 3}, Tet{1, 2, 3, 4}));
      EXPECT_THAT(grid.mesh.region, ElementsAre(7, 9));
      EXPECT_TRUE(grid.mesh.mids.empty());
      EXPECT_EQ(named(grid.point_fields, "u").components, 3);
      EXPECT_EQ(named(grid.point_fields, "u").values, std::vector<double>(15, 1.5));
      EXPECT_EQ(named(grid.point_fields, "its name").components, 2);
      EXPECT_EQ(named(grid.point_fields, "its name").values.back(), 10);
    }
}

TEST(LegacyVtk, SplitsPolygonsAndStripsWithTheirFields) {
  const Vtu grid = parse_legacy_vtk(legacy_vtk_surface(), "a.vtk");
  EXPECT_THAT(grid.triangles.triangles,
              ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}, Triangle{0, 1, 3}, Triangle{3, 1, 2}));
  EXPECT_THAT(named(grid.cell_fields, "part").values, ElementsAre(2, 2, 3, 3));
}

TEST(LegacyVtk, ReadsQuadraticTetsAndSkipsTheirFaces) {
  std::string text = "# vtk DataFile Version 2.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 10 float\n";
  for (int i = 0; i < 10; ++i) text += std::to_string(i) + " " + std::to_string(i * i) + " 0\n";
  text += "CELLS 2 18\n10 0 1 2 3 4 5 6 7 8 9\n6 0 1 2 4 5 6\nCELL_TYPES 2\n24\n22\n";
  const Vtu grid = parse_legacy_vtk(text, "a.vtk");
  EXPECT_THAT(grid.mesh.tets, ElementsAre(Tet{0, 1, 2, 3}));
  EXPECT_THAT(grid.mesh.mids, ElementsAre(MidNodes{4, 5, 6, 7, 8, 9}));
}

TEST(LegacyVtk, SkipsTextsBitsColorsAndTables) {
  const std::string more =
      "COLOR_SCALARS rgb 3\n0 0 1 0 1 0 1 0 0 1 1 1 0 0 0\nLOOKUP_TABLE own 1\n0 0 0 1\n"
      "FIELD more 3\nlabels 1 5 string\nfirst label\n2\n3\n4\n5\nflags 1 5 bit\n0 1 0 1 1\nNULL_ARRAY\n"
      "SCALARS t double\nLOOKUP_TABLE own\nnan 1 2 3 4\n";
  const Vtu grid = parse_legacy_vtk(legacy_vtk(false, false) + more, "a.vtk");
  EXPECT_TRUE(std::isnan(named(grid.point_fields, "t").values[0]));
  EXPECT_EQ(named(grid.point_fields, "t").values[4], 4);
}

TEST(LegacyVtk, FileFieldsMayHaveAnyLength) {
  const std::string text =
      with(legacy_vtk(false, false), "DATASET", "FIELD FieldData 1\nTIME 1 2 double\n0.5 0.75\nDATASET");
  EXPECT_THAT(named(parse_legacy_vtk(text, "a.vtk").file_fields, "TIME").values, ElementsAre(0.5, 0.75));
}

TEST(LegacyVtk, ErrorsNamePlaceAndRemedy) {
  const std::string text = legacy_vtk(false, false);
  EXPECT_THAT(legacy_error("ply"), HasSubstr("a.vtk:1: found 'ply' where '# vtk DataFile Version' should be"));
  EXPECT_THAT(legacy_error(with(text, "ASCII", "TEXT")), HasSubstr("a.vtk:3: the third line is 'TEXT'"));
  EXPECT_THAT(legacy_error(with(text, "UNSTRUCTURED_GRID", "STRUCTURED_POINTS")),
              HasSubstr("a.vtk:4: the grid is 'structured_points'; only UNSTRUCTURED_GRID and POLYDATA are read"));
  EXPECT_THAT(legacy_error(with(text, "POINTS 5", "POINTS 500000")), HasSubstr("a.vtk:5: the number of values"));
  EXPECT_THAT(legacy_error(with(text, "POINTS 5", "POINTS -5")), HasSubstr("must be from 0 to"));
  EXPECT_THAT(legacy_error(with(text, "10 10", "10 12")), HasSubstr("a.vtk:7: cell 1 has type 12; only tets"));
  EXPECT_THAT(legacy_error(with(text, "4 1 2 3 4", "4 1 2 3 5")), HasSubstr("a cell names point 5 of 5"));
  EXPECT_THAT(legacy_error(with(text, "CELLS 2 10", "CELLS 3 10")), HasSubstr("states 3 cells, but holds 2"));
  EXPECT_THAT(legacy_error(with(text, "CELL_DATA 2", "CELL_DATA 3")), HasSubstr("3 values where 2 are needed"));
  EXPECT_THAT(legacy_error(with(text, "1.000000", "nan")), HasSubstr("a.vtk:5: point 1 is not finite"));
  EXPECT_THAT(legacy_error(with(legacy_vtk(true, true), "POINTS 5", "POINTS 9999")), HasSubstr("a.vtk: byte "));
}

}  // namespace
}  // namespace aspic
