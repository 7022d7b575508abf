#include "aspic/sweep/study.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "aspic/sweep/study_draws.h"
#include "base/hash.h"
#include "scene/scene_cases_test.h"

namespace aspic {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

// The first numbers of the published generator from state 0.
TEST(StudyDraws, MatchSplitMix64) {
  Draws draws(0 - Fnv1a::kBasis, "");
  EXPECT_EQ(draws.next(), 0xe220a8397b1dcdafu);
  EXPECT_EQ(draws.next(), 0x6e789e6aa1b965f4u);
  EXPECT_EQ(draws.next(), 0x06c45d188009454fu);
}

TEST(StudyDraws, DependOnSeedAndName) {
  const std::vector<double> draws = random_sample(Draws(1, "material.young"), 50);
  EXPECT_EQ(draws, random_sample(Draws(1, "material.young"), 50));
  EXPECT_NE(draws, random_sample(Draws(2, "material.young"), 50));
  EXPECT_NE(draws, random_sample(Draws(1, "material.poisson"), 50));
}

TEST(StudyDraws, MoreDrawsKeepTheEarlierOnes) {
  const std::vector<double> few = random_sample(Draws(7, "x"), 10), many = random_sample(Draws(7, "x"), 100);
  EXPECT_TRUE(std::equal(few.begin(), few.end(), many.begin()));
}

TEST(StudyDraws, RandomSampleIsUniform) {
  constexpr int kCount = 100'000;
  double sum = 0, squares = 0;
  for (const double u : random_sample(Draws(3, "x"), kCount)) {
    ASSERT_GE(u, 0);
    ASSERT_LT(u, 1);
    sum += u;
    squares += u * u;
  }
  const double sigma = 1 / std::sqrt(kCount);  // above those of both means, by factors of 3.5 and 3.4
  EXPECT_NEAR(sum / kCount, 1.0 / 2, sigma);
  EXPECT_NEAR(squares / kCount, 1.0 / 3, sigma);
}

TEST(StudyDraws, LatinHypercubeHasOneDrawPerStratum) {
  for (const int count : {2, 3, 10, 1000}) {
    std::set<int> strata;
    for (const double u : latin_hypercube(Draws(1, "x"), count)) strata.insert(static_cast<int>(u * count));
    EXPECT_EQ(strata.size(), static_cast<size_t>(count));
    EXPECT_EQ(*strata.begin(), 0);
    EXPECT_EQ(*strata.rbegin(), count - 1);
  }
  EXPECT_FALSE(std::is_sorted(latin_hypercube(Draws(1, "x"), 10).begin(), latin_hypercube(Draws(1, "x"), 10).begin()));
}

TEST(StudyRange, GridsHaveReadableValuesAndExactEnds) {
  EXPECT_THAT((StudyRange{0, 0.6}.grid(4)), ElementsAre(0, 0.2, 0.4, 0.6));
  EXPECT_THAT((StudyRange{1e4, 1e6, StudyScale::logarithmic}.grid(3)), ElementsAre(1e4, 1e5, 1e6));
  const double odd = std::nextafter(0.1, 1);
  EXPECT_EQ((StudyRange{odd, 1}.grid(2).front()), odd);
}

TEST(StudyRange, LogarithmicSharesArePowers) {
  const StudyRange range{3e-3, 7e8, StudyScale::logarithmic};
  for (const double share : random_sample(Draws(1, "x"), 1000)) {
    const double expected = 3e-3 * std::pow(7e8 / 3e-3, share);
    EXPECT_NEAR(range.at(share) / expected, 1, 53 * 2.3e-16);  // one rounding per factor
  }
}

class StudyFile : public testing::Test {
 protected:
  Study read(const std::string& text) const { return read_study(folder_.write("study.toml", text)); }
  std::string refusal(const std::string& text) const {
    return message_of([&] { read(text); });
  }

  const TestFolder folder_;
  const std::filesystem::path scene_ =
      folder_.write("beam.toml", kCube + "[[body.pin]]\nname = \"base\"\nwhere = \"Y < 0.1\"\n");
};

const std::string kHead = "scene = \"beam.toml\"\n";

TEST_F(StudyFile, ListsAndGridsFormTheProduct) {
  const Study study = read(kHead +
                           "[vary]\nmaterial.model = [\"neo_hookean\", \"stvk\"]\n"
                           "material.young = { from = 1e4, to = 1e6, count = 3, scale = \"log\" }\n");
  EXPECT_THAT(study.keys, ElementsAre("material.model", "material.young"));
  EXPECT_THAT(study.cases, ElementsAre(ElementsAre("neo_hookean", "10000"), ElementsAre("neo_hookean", "100000"),
                                       ElementsAre("neo_hookean", "1000000"), ElementsAre("stvk", "10000"),
                                       ElementsAre("stvk", "100000"), ElementsAre("stvk", "1000000")));
  EXPECT_THAT(study.overrides(1), ElementsAre("material.model=neo_hookean", "material.young=100000"));
}

TEST_F(StudyFile, DrawsRepeatForEachMemberOfTheProduct) {
  const Study study = read(kHead +
                           "sample = { count = 5 }\n[vary]\ntime.step = [0.01, 0.02]\n"
                           "material.young = { from = 1e4, to = 1e6 }\n");
  ASSERT_EQ(study.cases.size(), 10u);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(study.cases[i][0], "0.01");
    EXPECT_EQ(study.cases[i + 5][0], "0.02");
    EXPECT_EQ(study.cases[i][1], study.cases[i + 5][1]);
  }
}

TEST_F(StudyFile, FurtherKeysKeepTheDraws) {
  const std::string head = kHead + "sample = { method = \"random\", count = 4, seed = 9 }\n[vary]\n";
  const std::string young = "material.young = { from = 1e4, to = 1e6 }\n";
  const Study one = read(head + young), two = read(head + "material.poisson = { from = 0.1, to = 0.4 }\n" + young);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(one.cases[i][0], two.cases[i][1]);
}

TEST_F(StudyFile, KeysMayHaveTheNamesOfRanges) {
  const Study study = read(kHead + "[vary]\nbody.cube.scale = [1, 2]\n\"time.step\" = [0.01]\n");
  EXPECT_THAT(study.keys, ElementsAre("body.cube.scale", "time.step"));
}

TEST_F(StudyFile, ValuesKeepTheirTypes) {
  const Study study = read(kHead +
                           "[vary]\nsolver.max_iterations = { from = 100, to = 300, count = 3 }\n"
                           "material.young = [\"1e5 * (1 + X)\", 2e5]\ngravity = [[0, -9.81, 0], [1, 0, 0]]\n");
  EXPECT_EQ(study.cases.size(), 12u);
  EXPECT_THAT(study.cases[0], ElementsAre("100", "1e5 * (1 + X)", "[0, -9.81, 0]"));
}

TEST_F(StudyFile, TableHasOneCasePerRow) {
  folder_.write("cases.csv", "case,material.young,material.model\n1,1e4,stvk\n2,,neo_hookean\n");
  const Study study = read(kHead + "cases = \"cases.csv\"\n");
  EXPECT_THAT(study.overrides(0), ElementsAre("material.young=1e4", "material.model=stvk"));
  EXPECT_THAT(study.overrides(1), ElementsAre("material.model=neo_hookean"));  // a blank keeps the value of the scene
}

struct BadStudy {
  std::string text, line, reason;
};

TEST_F(StudyFile, RefusesWithLineValueAndRemedy) {
  const std::string vary = kHead + "[vary]\n";
  for (const BadStudy& bad : std::vector<BadStudy>{
           {"", "1:1", "needs the key 'scene'"},
           {kHead, "1:1", "needs one of: vary, sample | cases"},
           {kHead + "vari = 1\n" + "[vary]\ntime.step = [1]\n", "2", "did you mean 'vary'?"},
           {"scene = \"none.toml\"\n[vary]\ntime.step = [1]\n", "1",
            "does not exist (the path is relative to the study)"},
           {"scene = \"beam.mesh\"\n[vary]\ntime.step = [1]\n", "1", "is no .toml file"},
           {vary, "2", "[vary] is empty"},
           {vary + "material.yuong = [1e4]\n", "3", "did you mean 'young'?"},
           {vary + "material.young = [1e4, -1]\n", "3", "material.young=-1: young = -1; must be > 0"},
           {vary + "material.young = 1e4\n", "3", "needs a list"},
           {vary + "material.young = []\n", "3", "at least one value"},
           {vary + "material.young = [1e4]\nmaterial.\"young\" = [1e4]\n", "4", "young"},
           {vary + "material.young = [1e4]\n\"material.young\" = [1e5]\n", "4", "varies already at"},
           {vary + "body.other.scale = [1]\n", "3", "unknown key or name 'other'"},
           {vary + "material.young = { from = 1, to = 2 }\n", "3", "add count = 5, or sample"},
           {vary + "material.young = { from = 1, to = 1, count = 2 }\n", "3", "must be above from = 1"},
           {vary + "material.young = { from = 0, to = 1, count = 2, scale = \"log\" }\n", "3",
            "must be > 0 with scale"},
           {vary + "material.young = { from = 1, to = nan, count = 2 }\n", "3", "finite"},
           {vary + "material.young = { from = 1, to = 2, count = 1 }\n", "3", "must be >= 2"},
           {vary + "material.young = { from = 1, to = 2, cuont = 3 }\n", "3", "did you mean 'count'?"},
           {vary + "material.young = { from = 1, count = 3 }\n", "3", "needs the key 'to'"},
           {vary + "material.poisson = { from = 0.1, to = 0.5, count = 3 }\n", "3", "poisson"},
           {vary + "solver.max_iterations = { from = 1, to = 2, count = 3 }\n", "3", "expected an integer"},
           {vary +
                "material.young = { from = 1, to = 2, count = 1000 }\ntime.step = { from = 1, to = 2, count = 1000 }\n",
            "2", "1000000 cases; at most 100000"},
           {kHead + "sample = { count = 3 }\n[vary]\ntime.step = [1]\n", "2", "nothing to draw"},
           {kHead + "sample = { count = 200000 }\n[vary]\ntime.step = { from = 1, to = 2 }\n", "2", "must be"},
           {kHead + "sample = { count = 3, seed = -1 }\n[vary]\ntime.step = { from = 1, to = 2 }\n", "2", "seed = -1"},
           {kHead + "sample = { count = 3, method = \"sobol\" }\n[vary]\ntime.step = { from = 1, to = 2 }\n", "2",
            "latin_hypercube"},
           {kHead + "cases = \"none.csv\"\n", "2", "does not exist"}}) {
    SCOPED_TRACE(bad.text);
    EXPECT_THAT(refusal(bad.text), AllOf(HasSubstr("study.toml:" + bad.line), HasSubstr(bad.reason)));
  }
}

TEST_F(StudyFile, RefusesBadTables) {
  const auto refused = [&](const std::string& table) {
    folder_.write("cases.csv", table);
    return refusal(kHead + "cases = \"cases.csv\"\n");
  };
  EXPECT_THAT(refused("material.young\n1e4\n-1\n"), AllOf(HasSubstr("cases.csv:3"), HasSubstr("must be > 0")));
  EXPECT_THAT(refused("material.yuong\n1e4\n"), AllOf(HasSubstr("cases.csv:2"), HasSubstr("'young'")));
  EXPECT_THAT(refused("material.young,material.young\n1,2\n"), HasSubstr("occurs twice"));
  EXPECT_THAT(refused("material.young\n"), HasSubstr("has no rows"));
  EXPECT_THAT(refused("case\n1\n"), HasSubstr("no column is a key"));
  EXPECT_THAT(refused("material.young,time.step\n1e4\n"), HasSubstr("cases.csv:2"));
}

TEST_F(StudyFile, ErrorsOfTheSceneNameTheScene) {
  folder_.write("beam.toml", kCube + "[time]\nstep = -1\n");
  EXPECT_THAT(refusal(kHead + "[vary]\nmaterial.young = [1e4]\n"), HasSubstr("beam.toml:5"));
}

}  // namespace
}  // namespace aspic
