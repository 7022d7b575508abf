// Runs and scenes from untrusted sources: files that must not be touched, texts that are rejected.
#include <gmock/gmock.h>

#include "base/printable.h"
#include "io/atomic_file.h"
#include "results/run_directory.h"
#include "scene/scene_cases_test.h"
#include "scene/tables.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class HostileRun : public FolderTest {
 protected:
  HostileRun() : run_(path("run")) {
    put(path("cube.toml"), kCube);
    Scene scene = load_scene(path("cube.toml"));
    RunDirectory directory = RunDirectory::create(run_, scene, ExistingRun::refuse);
    directory.finish(scene.simulation);
  }
  // Moves a file or folder of the run and leaves a link to it.
  fs::path moved_out(const std::string& name) {
    fs::path elsewhere = path("elsewhere");
    fs::rename(run_ / name, elsewhere);
    fs::create_symlink(elsewhere, run_ / name);
    return elsewhere;
  }
  std::string resumed() const {
    return message_of([&] {
      Scene scene = load_scene(scene_of_run(run_));
      RunDirectory::resume(run_, scene);
    });
  }
  std::string replaced() const {
    return message_of([&] { RunDirectory::create(run_, load_scene(path("cube.toml")), ExistingRun::overwrite); });
  }

  fs::path run_;
};

TEST_F(HostileRun, IsNotContinuedThroughLinks) {
  for (const char* name : {"steps.csv", "timings.csv", "checkpoint.bin", "run.pvd"}) {
    const fs::path elsewhere = moved_out(name);
    const std::string before = read_file(elsewhere);
    EXPECT_THAT(resumed(), HasSubstr(std::string(name) + ": is a link")) << name;
    EXPECT_EQ(read_file(elsewhere), before) << name;
    fs::remove(run_ / name);
    fs::rename(elsewhere, run_ / name);
  }
  EXPECT_EQ(resumed(), "");
}

TEST_F(HostileRun, IsNotReplacedThroughLinks) {
  const fs::path elsewhere = moved_out("frames");
  EXPECT_THAT(replaced(), HasSubstr("frames: is a link"));
  EXPECT_TRUE(fs::exists(elsewhere / "body_000000.vtu"));
}

TEST_F(HostileRun, IsRecognizedInAnyFolderName) {
  fs::rename(run_, path("inputs"));
  run_ = path("inputs") / "";
  fs::create_directory(run_ / "mine");
  fs::create_symlink(path("cube.toml"), run_ / "mine" / "link");
  EXPECT_EQ(resumed(), "");
  moved_out("steps.csv");
  EXPECT_THAT(resumed(), HasSubstr("steps.csv: is a link"));
}

TEST_F(HostileRun, TableIsRecognizedByBoundedRead) {
  fs::resize_file(run_ / "steps.csv", 0);
  fs::resize_file(run_ / "steps.csv", std::uintmax_t{1} << 40);  // nothing but zeros, and no line break
  EXPECT_THAT(resumed(), HasSubstr("contains no run"));
}

TEST(HostileScene, RejectsControlCharacters) {
  const std::string shape = "shape = { box = { upper = [1, 1, 1], cells = [1, 1, 1] } }\n";
  for (const char* name : {R"(a\u001b[31m)", R"(a\nb)", R"(a\u202eb)", R"(a\u009b)"})
    EXPECT_THAT(refusal("[[body]]\nname = \"" + std::string(name) + "\"\n" + shape),
                HasSubstr("must be UTF-8 without control characters"))
        << name;
  EXPECT_THAT(refusal(kCube, {"body.cube.name=\xff"}), HasSubstr("must be UTF-8"));
}

TEST(HostileScene, IsQuotedInOneLine) {
  for (const std::string& text :
       {kCube + "\"\\u001b]0;x\\u0007\" = 1\n", kCube + "[[body.pin]]\nwhere = \"\\u001b[2J\"\n",
        std::string("\x1b[2J = 1"), std::string("a = \x1b"), kCube + "velocity = [\"\\u0007\", 0, 0]\n"}) {
    const std::string why = refusal(text);
    EXPECT_NE(why, "");
    EXPECT_TRUE(is_printable(why)) << why;
  }
}

TEST(HostileScene, HasAtMostTenThousandBodies) {
  std::string bodies;
  for (int i = 0; i < 10001; ++i) bodies += "[[body]]\nshape = { box = { upper = [1, 1, 1], cells = [1, 1, 1] } }\n";
  EXPECT_THAT(refusal(bodies), HasSubstr("10001 bodies; at most 10000 are supported"));
}

TEST(HostileScene, TablesHaveLinesOfAtMostAMebibyte) {
  const TestFolder folder;
  const fs::path file = folder.write("values.csv", std::string(size_t{1} << 21, ','));
  EXPECT_THAT(message_of([&] { read_number_table(file, 1, 1, "a tet", {}); }), HasSubstr(":1: is too long"));
}

}  // namespace
}  // namespace aspic
