#include "page/fit_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "io/base64.h"
#include "io/gzip.h"
#include "pipeline/case_figures.h"
#include "pipeline/indented_block_test.h"
#include "viewer/arguments.h"

namespace aspic::viewer {
namespace {

using testing::HasSubstr;

// The data of the page, unpacked as by its script.
struct Unpacked {
  explicit Unpacked(const std::string& html) {
    const std::string begin = "<script type=\"application/json\" id=\"fit\">\"";
    const size_t start = html.find(begin) + begin.size(), end = html.find("\"</script>", start);
    std::string_view rest(html.data() + start, end - start);
    std::string packed;
    EXPECT_TRUE(decode_base64(rest, rest.size(), packed));
    bytes = gunzipped(packed, 1 << 24);
    uint32_t length = 0;
    std::memcpy(&length, bytes.data(), 4);
    head = Json::parse(bytes.substr(4, length));
    data = (4 + length + 3) / 4 * 4;
  }

  std::vector<float> floats(const std::string& name) const {
    for (const Json& entry : head["arrays"]) {
      if (entry["name"] != name) continue;
      std::vector<float> numbers(entry["count"].get<size_t>());
      std::memcpy(numbers.data(), bytes.data() + data + entry["at"].get<size_t>(), 4 * numbers.size());
      return numbers;
    }
    ADD_FAILURE() << "no array " << name;
    return {};
  }

  std::string bytes;
  Json head;
  size_t data = 0;
};

FitOutcome fitted(const DataSet& data) {
  FitPlan plan;
  plan.parameters = {parse_parameter("young=regions")};
  plan.known = {{"poisson", 0.4}};
  plan.left_out = {"poke 2"};
  plan.cross_validation = false;
  return fit_material(data, plan, {}, {});
}

std::string page_of(const DataSet& data, const FitOutcome& outcome, const std::vector<FitIteration>& history) {
  const std::string figures = R"({"residuals": 12})";
  return fit_page({data, outcome, history, figures});
}

TEST(FitPage, HasMeasurementsAndResults) {
  const DataSet data = measured_block(2);
  const FitOutcome outcome = fitted(data);
  ASSERT_TRUE(outcome.has_material()) << outcome.failure;
  const Unpacked page(page_of(data, outcome, {{.index = 1, .misfit = 7}}));
  const Json& head = page.head;
  EXPECT_EQ(head["name"], "block");
  EXPECT_EQ(head["model"], "neo_hookean");
  EXPECT_EQ(head["counts"]["tets"], 48);
  EXPECT_TRUE(head["fit"]["success"]);
  EXPECT_EQ(head["fit"]["mesh"], "a material per tet of 48, simulated on 48 tets");
  EXPECT_EQ(head["history"][0]["misfit"], 7);
  EXPECT_EQ(head["figures"]["residuals"], 12);
  ASSERT_EQ(head["quantities"].size(), 2u);
  EXPECT_EQ(head["quantities"][0]["rows"].size(), 2u);
  EXPECT_LT(head["quantities"][0]["rows"][0]["lower"], head["quantities"][0]["rows"][0]["value"]);
  EXPECT_EQ(head["quantities"][1]["rows"][0]["where"], "given");

  const Json& cases = head["cases"];
  ASSERT_EQ(cases.size(), 6u);
  EXPECT_FALSE(cases[0]["leftOut"]);
  EXPECT_TRUE(cases[2]["leftOut"]);
  EXPECT_EQ(cases[1]["first"], cases[0]["count"]);

  EXPECT_EQ(page.floats("tet.young").size(), 48u);
  EXPECT_EQ(page.floats("tet.young_deviation").size(), 48u);
  const std::vector<float> measured = page.floats("reading.measured"), predicted = page.floats("reading.predicted"),
                           held_out = page.floats("reading.heldOut");
  ASSERT_EQ(measured.size(), predicted.size());
  for (size_t i = 0; i < measured.size(); ++i) EXPECT_NEAR(measured[i], predicted[i], 2e-4) << i;
  EXPECT_TRUE(std::isnan(held_out.front())) << "of a case that was fitted";
}

TEST(FitPage, NamesMarkers) {
  DataSet data = measured_block(2);
  for (size_t m = 0; m < data.experiment.markers.size(); ++m) data.marker_names.push_back("dot " + std::to_string(m));
  const FitOutcome outcome = fitted(data);
  ASSERT_TRUE(outcome.has_material()) << outcome.failure;
  EXPECT_EQ(Unpacked(page_of(data, outcome, {})).head["markerNames"][3], "dot 3");
}

TEST(FitPage, ContainsTheWorstOfManyReadings) {
  DataSet data = measured_block(2);
  FitOutcome outcome = fitted(data);
  ASSERT_TRUE(outcome.has_material()) << outcome.failure;
  // Copies of the first reading of the first case, one of which is far off.
  LoadCase& load = data.experiment.cases[0];
  CaseOutcome& predicted = outcome.cases[0];
  const size_t count = 4 * kMaxShownReadings, worst = 12345;
  load.positions.assign(count, load.positions[0]);
  for (auto* list : {&predicted.markers, &predicted.markers_on_mesh, &predicted.marker_sigma})
    list->assign(count, (*list)[0]);
  predicted.has_held_out = false;
  load.positions[worst].position[2] += 1;
  const Unpacked page(page_of(data, outcome, {}));
  const size_t shown = page.head["cases"][0]["count"];
  EXPECT_LE(shown, kMaxShownReadings + 1);
  EXPECT_EQ(page.head["cases"][0]["hidden"], count - shown);
  const std::vector<float> measured = page.floats("reading.measured");
  int far = 0;
  for (size_t i = 0; i < shown; ++i) far += measured[3 * i + 2] > 0.9 ? 1 : 0;
  EXPECT_EQ(far, 1);
}

TEST(FitPage, KeepsTheScriptsOfThePage) {
  const DataSet data = measured_block(2);
  FitOutcome outcome = fitted(data);
  outcome.warnings = {"</script><b>"};
  const std::string html = page_of(data, outcome, {});
  EXPECT_THAT(html, HasSubstr("<script>"));
  EXPECT_EQ(html.find("<b>"), std::string::npos) << "messages are packed in the page";
}

}  // namespace
}  // namespace aspic::viewer
