#include "viewer/fit_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "capture/indented_block_test.h"
#include "io/base64.h"
#include "io/gzip.h"
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

TEST(FitPage, HasMeasurementsAndResults) {
  const DataSet data = measured_block(2);
  const FitOutcome outcome = fitted(data);
  ASSERT_TRUE(outcome.has_material()) << outcome.failure;
  const Unpacked page(fit_page(data, outcome, {{.index = 1, .misfit = 7}}));
  const Json& head = page.head;
  EXPECT_EQ(head["name"], "block");
  EXPECT_EQ(head["model"], "neo_hookean");
  EXPECT_EQ(head["counts"]["tets"], 48);
  EXPECT_TRUE(head["fit"]["success"]);
  EXPECT_EQ(head["fit"]["mesh"], "a material per tet of 48, simulated on 48 tets");
  EXPECT_EQ(head["history"][0]["misfit"], 7);
  ASSERT_EQ(head["quantities"].size(), 2u);
  EXPECT_EQ(head["quantities"][0]["rows"].size(), 2u);
  EXPECT_LT(head["quantities"][0]["rows"][0]["lower"], head["quantities"][0]["rows"][0]["value"]);
  EXPECT_EQ(head["quantities"][1]["rows"][0]["where"], "given");

  const Json& cases = head["cases"];
  ASSERT_EQ(cases.size(), 6u);
  EXPECT_FALSE(cases[0]["leftOut"]);
  EXPECT_TRUE(cases[0]["force"]["heldOut"].is_null());
  EXPECT_TRUE(cases[2]["leftOut"]);
  EXPECT_NEAR(cases[2]["force"]["heldOut"][1], cases[2]["force"]["measured"][1],
              0.02 * std::abs(cases[2]["force"]["measured"][1].get<double>()));
  EXPECT_EQ(cases[1]["first"], cases[0]["count"]);

  EXPECT_EQ(page.floats("tet.young").size(), 48u);
  EXPECT_EQ(page.floats("tet.young_deviation").size(), 48u);
  const std::vector<float> measured = page.floats("reading.measured"), predicted = page.floats("reading.predicted"),
                           held_out = page.floats("reading.heldOut");
  ASSERT_EQ(measured.size(), predicted.size());
  for (size_t i = 0; i < measured.size(); ++i) EXPECT_NEAR(measured[i], predicted[i], 2e-4) << i;
  EXPECT_TRUE(std::isnan(held_out.front())) << "of a case that was fitted";
}

TEST(FitPage, NamesMarkersAndGivesTorquesWithTheirAngle) {
  DataSet data = measured_block(2);
  for (size_t m = 0; m < data.experiment.markers.size(); ++m) data.marker_names.push_back("dot " + std::to_string(m));
  LoadCase& twist = data.experiment.cases[0];
  twist.pose.rotation = {{0, 0.05, 0}};
  twist.torque = Vec3d{{0, 1e-3, 0}};
  twist.torque_sigma = {{1, 1, 1}};
  const FitOutcome outcome = fitted(data);
  ASSERT_TRUE(outcome.has_material()) << outcome.failure;
  const Json head = Unpacked(fit_page(data, outcome, {})).head;
  EXPECT_EQ(head["markerNames"][3], "dot 3");
  EXPECT_EQ(head["cases"][0]["tip"]["turn"], Json({0.0, 0.05, 0.0}));
  EXPECT_EQ(head["cases"][0]["torque"]["measured"][1], 1e-3);
  EXPECT_GT(head["cases"][0]["torque"]["predicted"][1].get<double>(), 0);
  EXPECT_NEAR(head["cases"][0]["torque"]["deviation"][1].get<double>(), 1, 1e-9);
  EXPECT_TRUE(head["cases"][1]["torque"].is_null());
}

TEST(FitPage, KeepsTheScriptsOfThePage) {
  const DataSet data = measured_block(2);
  FitOutcome outcome = fitted(data);
  outcome.warnings = {"</script><b>"};
  const std::string html = fit_page(data, outcome, {});
  EXPECT_THAT(html, HasSubstr("<script>"));
  EXPECT_EQ(html.find("<b>"), std::string::npos) << "messages are packed in the page";
}

}  // namespace
}  // namespace aspic::viewer
