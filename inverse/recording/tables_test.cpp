// Tables of image correlation, arrays of numpy and sequences of surfaces.
#include <gmock/gmock.h>

#include "base/error.h"
#include "io/folder_test.h"
#include "io/zip.h"
#include "recording/formats.h"

namespace aspic {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class RecordedTables : public FolderTest {
 protected:
  Recording read(const std::string& name) { return read_recording(path(name)); }
  std::string refusal(const std::string& name) {
    try {
      read(name);
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "";
  }
};

TEST_F(RecordedTables, ReadsDiceFrames) {
  const std::string head =
      "SUBSET_ID,MODEL_COORDINATES_X,MODEL_COORDINATES_Y,MODEL_COORDINATES_Z,MODEL_DISPLACEMENT_X,"
      "MODEL_DISPLACEMENT_Y,MODEL_DISPLACEMENT_Z,SIGMA\n";
  folder.write("s_9.txt", head + "0,1,2,3,0.5,0,0,0.01\n1,4,5,6,0,0,0,-1\n");
  folder.write("s_10.txt", head + "1,4,5,6,0,0,1,0.01\n0,1,2,3,0,0,0,0.01\n");
  const Recording r = read("s_*.txt");
  EXPECT_THAT(r.names, ElementsAre("0", "1"));
  ASSERT_EQ(r.frames.size(), 3u);
  EXPECT_EQ(r.frames[0].positions[1][2], 6);
  EXPECT_EQ(r.frames[1].positions[0][0], 1.5);
  EXPECT_FALSE(is_seen(r.frames[1].positions[1]));
  EXPECT_EQ(r.frames[2].positions[1][2], 7);
}

TEST_F(RecordedTables, ReadsDiceHeadersAndRowsWithoutIds) {
  const std::string head =
      "***\n*** Digital Image Correlation Engine (DICe), Copyright 2021\n*** Subset size: 27, step size: x 5 y "
      "5\n***\n";
  folder.write("s.txt", head +
                            "COORDINATE_X,COORDINATE_Y,DISPLACEMENT_X,DISPLACEMENT_Y,SIGMA\n1.0E+00,2,0.5,0,0.01\n"
                            "3,4,0,0.25,-1\n");
  EXPECT_TRUE(is_recording(path("s.txt")));
  const Recording r = read("s.txt");
  EXPECT_TRUE(r.is_planar);
  EXPECT_THAT(r.names, ElementsAre("1", "2"));
  EXPECT_EQ(r.frames[1].positions[0][0], 1.5);
  EXPECT_FALSE(is_seen(r.frames[1].positions[1]));
  folder.write("n.txt", head +
                            "SUBSET_ID,COORDINATE_X,COORDINATE_Y,DISPLACEMENT_X,DISPLACEMENT_Y\n0.000E+00,1,2,0,0\n"
                            "1.200E+01,3,4,0,0\n");
  EXPECT_THAT(read("n.txt").names, ElementsAre("0", "12"));
  folder.write("bad.txt", head + "SUBSET_ID,COORDINATE_X,COORDINATE_Y,DISPLACEMENT_X\n0,1,2,0\n");
  EXPECT_THAT(
      refusal("bad.txt"),
      HasSubstr("bad.txt:5: is no table of image correlation; for a table of DICe (2D) it lacks DISPLACEMENT_Y"));
}

TEST_F(RecordedTables, ReadsEarlierColumnsOfPyvale) {
  folder.write("p.csv", "subset_x,subset_y,displacement_u,displacement_v,converged\n10,30,1,2,1\n10,60,1,2,0\n");
  const Recording r = read("p.csv");
  EXPECT_TRUE(r.is_planar);
  EXPECT_EQ(r.frames[1].positions[0][1], 32);
  EXPECT_FALSE(is_seen(r.frames[1].positions[1]));
}

TEST_F(RecordedTables, SubtractsDisplacementsOfPyvale) {
  folder.write(
      "p.csv",
      "\"stereo_disp_u_mm\",\"stereo_disp_v_mm\",\"stereo_disp_w_mm\",\"stereo_x_mm\",\"stereo_y_mm\",\"stereo_z_mm\","
      "\"stereo_converged\",\n1,0,0,5,6,7,1\nnan,nan,nan,nan,nan,nan,0\n");
  const Recording r = read("p.csv");
  EXPECT_EQ(r.unit, 1e-3);
  EXPECT_EQ(r.frames[0].positions[0][0], 4);
  EXPECT_EQ(r.frames[1].positions[0][0], 5);
  EXPECT_FALSE(is_seen(r.frames[1].positions[1]));
}

TEST_F(RecordedTables, TwoCoordinatesArePlanar) {
  folder.write("m.csv", "id,x,y,ux,uy\n0,11,20,1,0\n");
  const Recording r = read("m.csv");
  EXPECT_TRUE(r.is_planar);
  EXPECT_EQ(r.frames[0].positions[0][0], 10);
  EXPECT_TRUE(is_recording(path("m.csv")));
}

TEST_F(RecordedTables, TablesOfAspicAreNoRecordings) {
  folder.write("positions.csv", "case,marker,x,y,z\n");
  EXPECT_FALSE(is_recording(path("positions.csv")));
  EXPECT_FALSE(is_recording(path("missing.csv")));
}

TEST_F(RecordedTables, RefusesDamagedTables) {
  folder.write("a.csv", "X,Y,Z,U,V,W\n1,2,3,0,zero,0\n");
  EXPECT_THAT(refusal("a.csv"), HasSubstr("a.csv:2: V = 'zero' is not a number"));
  folder.write("b.csv", "X,Y,Z,U,V\n1,2,3,0,0\n");
  EXPECT_THAT(refusal("b.csv"),
              HasSubstr("b.csv:1: is no table of image correlation; for a table of X, Y, Z, U, V, W it lacks W"));
  folder.write("c.csv", "id,X,Y,Z,U,V,W\n7,1,2,3,0,0,0\n7,1,2,3,0,0,0\n");
  EXPECT_THAT(refusal("c.csv"), HasSubstr("c.csv:3: the point '7' is there twice"));
  folder.write("d.csv", "X,Y,Z,U,V,W\n");
  EXPECT_THAT(refusal("d.csv"), HasSubstr("has no points"));
}

TEST_F(RecordedTables, NotesNumbersOfFilesUnlikeFrames) {
  for (const char* name : {"s_0.obj", "s_1.obj", "t_1.obj", "t_02.obj"}) folder.write(name, "v 1 2 3\n");
  EXPECT_THAT(read("s_*.obj").notes,
              ElementsAre("frames count the files from 1: frame 1 = s_0.obj to frame 2 = s_1.obj"));
  EXPECT_THAT(read("t_*.obj").notes, ElementsAre());
  EXPECT_THAT(read("s_0.obj").notes, ElementsAre());
}

TEST_F(RecordedTables, ReadsMarkersOfSurfaces) {
  folder.write("s_1.obj", "v 9 9 9\nv 8 8 8\nv 7 7 7\no A\nv 1 2 3\np -1\nf 1 2 3\n");
  folder.write("s_2.obj", "v 9 9 9\nv 8 8 8\nv 7 7 7\nf 1 2 3\no A\nv 1 2 4\np 4\n");
  const Recording r = read("s_*.obj");
  EXPECT_THAT(r.names, ElementsAre("A"));
  EXPECT_EQ(r.frames[1].positions[0][2], 4);
  EXPECT_FALSE(r.has_times);
  folder.write("bad.obj", "v 1 2 3\no A\np 1\np 1\n");
  EXPECT_THAT(refusal("bad.obj"), HasSubstr("the marker 'A' is there twice"));
  folder.write("far.obj", "v 1 2 3\np 5\n");
  EXPECT_THAT(refusal("far.obj"), HasSubstr("far.obj:2: a point names vertex 5 of 1"));
}

std::string npy(const std::string& type, const std::string& shape, const std::string& data) {
  std::string head = "{'descr': '" + type + "', 'fortran_order': False, 'shape': " + shape + ", }\n";
  std::string bytes = "\x93NUMPY\x01";
  bytes += '\0';
  bytes += static_cast<char>(head.size());
  bytes += '\0';
  return bytes + head + data;
}

std::string npz_refusal(const std::string& array) {
  try {
    parse_npz("a.npz", zipped({{"positions.npy", array}}));
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

TEST(Npz, ReadsBigEndianFloats) {
  const std::string values("\x3f\x80\0\0\x40\0\0\0\x40\x40\0\0", 12);
  const Recording r = parse_npz("a.npz", zipped({{"positions.npy", npy(">f4", "(1, 1, 3)", values)}}));
  EXPECT_EQ(r.frames[0].positions[0][2], 3);
}

TEST(Npz, UnpacksOnlyNeededFilesAndEachOnce) {
  const std::string positions = npy("<f8", "(1, 1, 3)", std::string(24, '\0'));
  std::string archive = zipped({{"unneeded.bin", "not unpacked"}, {"positions.npy", positions}});
  archive[archive.find("unneeded.bin") + 12] ^= 0x10;  // its data are damaged
  EXPECT_EQ(parse_npz("a.npz", archive).frames.size(), 1u);
  EXPECT_THAT(
      [&] {
        parse_npz("a.npz", zipped({{"positions.npy", positions}, {"positions.npy", positions}}));
      },
      testing::ThrowsMessage<InvalidInput>(HasSubstr("'positions.npy' is there twice; remove one")));
}

// All names refer to the same packed bytes, which would be unpacked again and again.
TEST(Npz, RefusesOverlappingFiles) {
  const std::string positions = npy("<f8", "(1, 1, 3)", std::string(24, '\0'));
  std::string archive = zipped({{"positions.npy", positions}, {"names.npy", positions}, {"times.npy", positions}});
  const std::string entry = "PK\x01\x02";
  for (size_t at = archive.find(entry); at != std::string::npos; at = archive.find(entry, at + 1)) {
    const std::string size("\xff\xff\x01\0", 4);  // 131071 packed bytes of 0.5 kB
    archive.replace(at + 20, 4, size).replace(at + 42, 4, 4, '\0');
  }
  EXPECT_THAT([&] { parse_npz("a.npz", archive); },
              testing::ThrowsMessage<InvalidInput>(HasSubstr("the files of the archive overlap")));
}

TEST(Npz, RefusesDamage) {
  EXPECT_THAT(npz_refusal(npy("<f8", "(1, 1, 3)", "short")),
              HasSubstr("the number of values is 3, but the rest of the file"));
  EXPECT_THAT(npz_refusal(npy("<f8", "(99999999999, 99999999999, 3)", "")),
              HasSubstr("the shape of the array is larger"));
  EXPECT_THAT(npz_refusal(npy("<c16", "(1, 1, 3)", "")), HasSubstr("the type of the array is '<c16'"));
  EXPECT_THAT(npz_refusal(npy("|O", "(1, 1, 3)", "")), HasSubstr("texts by astype(str)"));
  const std::string infinity("\0\0\0\0\0\0\xf0\x7f", 8);
  EXPECT_THAT(npz_refusal(npy("<f8", "(2, 1, 3)", std::string(32, '\0') + infinity + std::string(8, '\0'))),
              HasSubstr("positions[1, 0, 1] of '0' is infinite; write NaN"));
  EXPECT_THAT(npz_refusal(npy("<f8", "(3,)", std::string(24, '\0'))), HasSubstr("positions has the shape (3)"));
  EXPECT_THAT(npz_refusal("no array"), HasSubstr("is no array of numpy"));
  const std::string archive = zipped({{"positions.npy", npy("<f8", "(1, 1, 3)", std::string(24, '\0'))}});
  for (size_t size = 0; size < archive.size(); ++size)
    EXPECT_THROW(parse_npz("a.npz", archive.substr(0, size)), InvalidInput) << size;
  std::string wrong = archive;
  wrong[60] = static_cast<char>(wrong[60] ^ 0x10);
  EXPECT_THROW(parse_npz("a.npz", wrong), InvalidInput);
}

}  // namespace
}  // namespace aspic
