#include "io/tetrahedralize.h"

#include <gmock/gmock.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include "io/atomic_file.h"
#include "io/external_program.h"
#include "io/folder_test.h"
#include "io/mesh_file.h"
#include "mesh/generators.h"
#include "mesh/surface.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

// Shell scripts replace the mesher and accept its command line: SURFACE -o OUT --size S.
class Tetrahedralize : public FolderTest {
 protected:
  Tetrahedralize() {
    fs::create_directory(folder / "temporary");
    surface = folder / "a b;c.off";  // must not pass through a shell
    write_mesh(surface, boundary_surface(make_box({{0, 0, 0}}, {{2, 2, 1}}, {1, 1, 1})).surface);
    write_mesh(folder / "tets.mesh", make_box({{0, 0, 0}}, {{2, 2, 1}}, {1, 1, 1}));
    ::setenv("TMPDIR", (folder / "temporary").c_str(), 1);
  }
  ~Tetrahedralize() override { ::unsetenv("TMPDIR"); }

  TetMesh run(const std::string& script, double size = 0) {
    write_file(folder / "mesher", "#!/bin/sh\n" + script);
    fs::permissions(folder / "mesher", fs::perms::owner_all);
    return tetrahedralize(surface, {.size = size, .program = folder / "mesher"}).tets;
  }
  void expect_no_leftovers() { EXPECT_TRUE(fs::is_empty(folder / "temporary")); }

  std::string good() {
    return "echo \"$0 $1 $2 $4 $5\" > '" + (folder / "said").string() + "'; cp '" + (folder / "tets.mesh").string() +
           "' \"$3\"";
  }
  fs::path surface;
};

TEST_F(Tetrahedralize, ReturnsTetsOfProgram) {
  EXPECT_EQ(run(good(), 0.25).tet_count(), 6);
  EXPECT_EQ(read_file(folder / "said"), (folder / "mesher").string() + " " + surface.string() + " -o --size 0.25\n");
  expect_no_leftovers();
}

TEST_F(Tetrahedralize, LeavesDefaultsToTheProgram) {
  run(good());
  EXPECT_EQ(read_file(folder / "said"), (folder / "mesher").string() + " " + surface.string() + " -o  \n");
}

TEST_F(Tetrahedralize, ReturnsNotesOfProgram) {
  write_file(folder / "mesher",
             "#!/bin/sh\necho \"$1: it is thin\"; echo 'tets 6'; cp '" + (folder / "tets.mesh").string() + "' \"$3\"");
  fs::permissions(folder / "mesher", fs::perms::owner_all);
  EXPECT_THAT(tetrahedralize(surface, {.program = folder / "mesher"}).notes, testing::ElementsAre("it is thin"));
}

TEST_F(Tetrahedralize, PassesTimeLimitAndItsFailure) {
  write_file(folder / "mesher", "#!/bin/sh\necho \"error: $4 $5: too slow\" >&2; exit 4");
  fs::permissions(folder / "mesher", fs::perms::owner_all);
  EXPECT_THROW(tetrahedralize(surface, {.seconds = 2.5, .program = folder / "mesher"}), TimeLimitPassed);
  EXPECT_THAT(message_of([&] { tetrahedralize(surface, {.seconds = 2.5, .program = folder / "mesher"}); }),
              HasSubstr("ran out of time: --time-limit 2.5: too slow"));
}

// A process starts the program and is killed. Then the program's end of the pipe closes.
TEST_F(Tetrahedralize, ProgramEndsWithItsParent) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  const pid_t parent = ::fork();
  if (parent == 0) {
    ::close(ends[0]);
    run("echo x > /dev/fd/" + std::to_string(ends[1]) + "; exec sleep 100");
    ::_exit(0);
  }
  ::close(ends[1]);
  char byte;
  ASSERT_EQ(::read(ends[0], &byte, 1), 1);  // the program is running
  ::kill(parent, SIGKILL);
  int status = 0;
  ::waitpid(parent, &status, 0);
  ssize_t count = 0;
  while ((count = ::read(ends[0], &byte, 1)) > 0) {
  }
  EXPECT_EQ(count, 0);
  ::close(ends[0]);
  fs::remove_all(folder / "temporary");
}

TEST_F(Tetrahedralize, ForwardsReasonOfFailure) {
  EXPECT_THAT(message_of([&] { run("echo the surface is open >&2; exit 2"); }),
              testing::AllOf(HasSubstr(surface.string()), HasSubstr("aspic-mesh failed: the surface is open")));
  EXPECT_THAT(message_of([&] { run("exit 3"); }), HasSubstr("it gave no reason"));
  EXPECT_THAT(message_of([&] { run("kill -KILL $$"); }), HasSubstr("signal 'Killed'"));
  EXPECT_THAT(message_of([&] { run("true"); }), HasSubstr("wrote no mesh"));
  EXPECT_THAT(message_of([&] { run("echo garbage > \"$3\""); }), HasSubstr("MeshVersionFormatted"));
  expect_no_leftovers();
}

TEST_F(Tetrahedralize, RejectsInvalidSizesAndPrograms) {
  EXPECT_THAT(message_of([&] { run(good(), -1); }), HasSubstr("must be positive"));
  EXPECT_THAT(message_of([&] { tetrahedralize(surface, {.program = folder / "none"}); }),
              HasSubstr("is not a program"));
  ::setenv("TMPDIR", "/nowhere", 1);
  EXPECT_THAT(message_of([&] { run(good()); }), HasSubstr("set TMPDIR to a folder with space"));
}

}  // namespace
}  // namespace aspic
