#include "io/zip.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "io/atomic_file.h"
#include "io/folder_test.h"

namespace aspic {
namespace {

using ZipArchive = FolderTest;

// Python reads the archive independently, and checks the CRCs, too.
TEST_F(ZipArchive, IsReadByPython) {
  const std::string zeros(100'000, '\0');
  write_file(path("a.zip"), zipped({{"scene/a.toml", "x = 1\n"}, {"scene/inputs/b.msh", zeros}, {"empty", ""}}));
  write_file(path("read.py"),
             "import sys, zipfile\n"
             "z = zipfile.ZipFile(sys.argv[1])\n"
             "assert z.testzip() is None\n"
             "assert z.namelist() == ['scene/a.toml', 'scene/inputs/b.msh', 'empty'], z.namelist()\n"
             "assert z.read('scene/a.toml') == b'x = 1\\n' and z.read('scene/inputs/b.msh') == bytes(100000)\n"
             "assert z.read('empty') == b''\n");
  const std::string command = "python3 '" + path("read.py").string() + "' '" + path("a.zip").string() + "'";
  EXPECT_EQ(std::system(command.c_str()), 0);
}

TEST_F(ZipArchive, IsDeterministic) { EXPECT_EQ(zipped({{"a", "text"}}), zipped({{"a", "text"}})); }

}  // namespace
}  // namespace aspic
