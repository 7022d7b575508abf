// A field of step reports is defined once and appears in every output.
#include "dynamics/step_fields.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "aspic/step_json.h"
#include "io/atomic_file.h"
#include "io/csv_reader.h"
#include "io/folder_test.h"
#include "io/vtu.h"
#include "results/run_directory.h"
#include "results/run_directory_layout.h"
#include "viewer/run_tables.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr char kScene[] = R"(
[time]
step = 0.01
duration = 0.02
[[body]]
name = "body"
shape = { box = { upper = [1, 1, 1], cells = [1, 1, 1] } }
material = { model = "neo_hookean", young = 1e5, poisson = 0.4, density = 1000 }
)";

// Represents a new member of StepReport; its value is 10 times the step number.
double last_read = 0;
StepField new_field() {
  return {.name = "new_number",
          .unit = "N",
          .help = "a new number",
          .type = StepFieldType::real,
          .outputs = 15,
          .get = [](const StepReport& r) { return StepValue(10.0 * r.step); },
          .set = [](StepReport&, const StepValue& v) { return last_read = std::get<double>(v), true; },
          .numbers = [](const StepReport& r) { return std::vector<double>{10.0 * r.step}; }};
}

class StepFields : public FolderTest {
 protected:
  void SetUp() override { put(path("cube.toml"), kScene); }
  // Returns the JSON line of the last step.
  std::string run() {
    Scene scene = load_scene(path("cube.toml"));
    RunDirectory directory = RunDirectory::create(path("run"), scene, ExistingRun::overwrite);
    std::string line;
    for (int i = 0; i < scene.steps; ++i) {
      const StepReport report = scene.simulation.step();
      directory.on_step(report, scene.simulation);
      line = cli::step_json(report, {}, scene.simulation);
    }
    directory.finish(scene.simulation);
    return line;
  }
};

TEST_F(StepFields, NewFieldAppearsInEveryOutput) {
  const AdditionalStepField added(new_field());
  EXPECT_EQ(nlohmann::json::parse(run())["new_number"], 20.0);
  CsvReader table(path("run/steps.csv"));
  ASSERT_TRUE(table.has("new_number"));
  const Vtu frame = read_vtu(path("run/frames/body_000002.vtu"));
  const auto field = std::find_if(frame.file_fields.begin(), frame.file_fields.end(),
                                  [](const Field& f) { return f.name == "new_number"; });
  ASSERT_NE(field, frame.file_fields.end());
  EXPECT_EQ(field->values, std::vector<double>{20.0});
  const viewer::RunTables read = viewer::read_run_tables(RunLayout(path("run")), 2);
  EXPECT_EQ(last_read, 20.0);
  EXPECT_EQ(viewer::to_json(read.steps.back())["new_number"], 20.0);
  EXPECT_THAT(step_fields_typescript(), HasSubstr("  new_number: MaybeNumber; // a new number [N]\n"));
  EXPECT_THAT(step_fields_markdown(), HasSubstr("* `new_number` [N]: a new number\n"));
}

TEST_F(StepFields, ReadBackEqualsWritten) {
  const nlohmann::json written = nlohmann::json::parse(run());
  const nlohmann::json read = viewer::to_json(viewer::read_run_tables(RunLayout(path("run")), 2).steps.back());
  for (const StepField& field : step_fields()) {
    const std::string name(field.name);
    if (!field.is_in(StepOutput::viewer) || !field.is_in(StepOutput::table)) continue;
    if (field.type == StepFieldType::potentials) continue;  // an object by name in JSON, an array for the viewer
    EXPECT_EQ(read[name], written[name]) << name;
  }
}

TEST_F(StepFields, RejectsUnknownName) {
  run();
  std::string text = read_file(path("run/steps.csv"));
  text.replace(text.rfind(",converged,"), 11, ",konverged,");
  write_file(path("run/steps.csv"), text);
  EXPECT_THAT(message_of([&] { viewer::read_run_tables(RunLayout(path("run")), 2); }),
              AllOf(HasSubstr("steps.csv:"), HasSubstr("unknown status 'konverged'")));
}

TEST(StepFieldFiles, AreUpToDate) {
  const fs::path source = ASPIC_SOURCE_DIR, typescript = source / "web/src/stepFields.ts",
                 formats = source / "docs/formats.md";
  std::string page = read_file(formats);
  const std::string head = "### steps.csv\n\n";
  const size_t begin = page.find(head) + head.size(), end = page.find("\n\n", begin) + 1;
  if (std::getenv("ASPIC_UPDATE_DOCS")) {
    write_file(typescript, step_fields_typescript());
    write_file(formats, page.replace(begin, end - begin, step_fields_markdown()));
    return;
  }
  EXPECT_EQ(read_file(typescript), step_fields_typescript()) << "ASPIC_UPDATE_DOCS=1 test_lessons rewrites it";
  EXPECT_EQ(page.substr(begin, end - begin), step_fields_markdown()) << "ASPIC_UPDATE_DOCS=1 test_lessons rewrites it";
}

}  // namespace
}  // namespace aspic
