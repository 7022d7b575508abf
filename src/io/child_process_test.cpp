#include "io/child_process.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>

#include "base/error.h"
#include "io/atomic_file.h"
#include "io/folder_test.h"

namespace aspic {
namespace {

class ChildProcessTest : public FolderTest {
 protected:
  Launch shell(const std::string& script) const {
    return {.command = {"/bin/sh", "-c", script}, .output = folder / "output", .messages = folder / "messages"};
  }
};

TEST_F(ChildProcessTest, PassesInputOutputAndMessages) {
  Launch launch = shell("cat; echo two words >&2; echo >&2");
  launch.has_input = true;
  ChildProcess process(launch);
  EXPECT_TRUE(process.write("given"));
  process.close_input();
  EXPECT_EQ(process.wait(), 0);
  EXPECT_EQ(read_file(folder / "output"), "given");
  EXPECT_EQ(process.message(), "two words");
}

TEST_F(ChildProcessTest, ReportsFailure) {
  ChildProcess process(shell("exit 3"));
  EXPECT_NE(process.wait(), 0);
  EXPECT_FALSE(process.is_running());
  EXPECT_EQ(process.message(), "it gave no reason");
}

TEST_F(ChildProcessTest, NamesProgramThatCannotBeStarted) {
  const auto message = [](const Launch& launch) -> std::string {
    try {
      ChildProcess process(launch, "install it");
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message({.command = {"/no/such/program"}}),
            "/no/such/program: cannot be run: No such file or directory; install it");
  EXPECT_THAT(message({.command = {"/bin/true"}, .messages = folder / "none" / "messages"}),
              testing::HasSubstr("No such file or directory"));
}

TEST_F(ChildProcessTest, EndsWithItsObject) {
  for (const Lifetime lifetime : {Lifetime::shared, Lifetime::own_group}) {
    Launch launch = shell("echo $$ >&2; exec sleep 1000");
    launch.lifetime = lifetime;
    pid_t pid = 0;
    {
      const ChildProcess process(launch);
      while (pid == 0) pid = std::atoi(process.message().c_str());
    }
    EXPECT_NE(::kill(pid, 0), 0);
  }
}

TEST_F(ChildProcessTest, DetachedOutlivesItsObject) {
  Launch launch = shell("echo $$ >&2; exec sleep 1000");
  launch.lifetime = Lifetime::detached;
  pid_t pid = 0;
  {
    const ChildProcess process(launch);
    while (pid == 0) pid = std::atoi(process.message().c_str());
  }
  EXPECT_EQ(::kill(pid, 0), 0);
  EXPECT_EQ(::kill(pid, SIGKILL), 0);
}

TEST_F(ChildProcessTest, WriteToEndedProgramFails) {
  Launch launch = shell("exit 0");
  launch.has_input = true;
  ChildProcess process(launch);
  process.wait();
  EXPECT_FALSE(process.write(std::string(1 << 20, 'x')));
}

}  // namespace
}  // namespace aspic
