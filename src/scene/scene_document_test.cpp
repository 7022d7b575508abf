// Rules of the schema and messages of errors.
#include "scene/scene_document.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "base/error.h"
#include "scene/overrides.h"
#include "scene/schema.h"
#include "scene/toml_reader.h"

namespace aspic {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

const std::string kBox = "[[body]]\nshape = { box = { upper = [1, 1, 1], cells = [2, 2, 2] } }\n";

Table document(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return read_scene_document(text, "beam.toml", overrides);
}

std::string document_refusal(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    document(text, overrides);
  } catch (const InvalidInput& e) {
    return e.what();
  }
  return "";
}

const Value& body(const Table& scene, size_t i = 0) { return scene.find("body")->array()[i]; }

TEST(SceneDocument, NeedsOnlyABody) {
  const Table scene = document(kBox);
  EXPECT_EQ((*scene.find("time"))["step"].number(), 0.01);
  EXPECT_EQ((*scene.find("solver"))["line_search"]["p"].number(), 0.5);
  EXPECT_EQ(body(scene)["name"].text(), "body1");
  EXPECT_EQ(body(scene)["material"]["young"].number(), 1e5);
  EXPECT_THAT(document_refusal("gravity = [0, 0, 0]\n"), HasSubstr("needs the key 'body'"));
  EXPECT_THAT(document_refusal("body = []\n"), HasSubstr("at least one"));
}

TEST(SceneDocument, CompletedTextReadsBackToItself) {
  const std::string text = "gravity = [0, -9.81, 1e-300]\n" + kBox +
                           "name = \"a\"\nmaterial = { model = \"neo_hookean\", shear = 0.1, bulk = 3 }\n"
                           "deform = { displacement = [0.1, \"X * \\\"\", 0] }\n";
  EXPECT_THAT(document_refusal(text), HasSubstr("unexpected character"));
  std::string good = text;
  good.replace(good.find("X * \\\""), 6, "X*Y");
  good += "[[body.pin]]\nwhere = { box = { lower = [0, 0, 0], upper = [1, 0.1, 1] } }\n";
  const std::string once = to_toml(document(good));
  EXPECT_EQ(once, to_toml(document(once)));
  EXPECT_THAT(once, HasSubstr("shear = 0.1, bulk = 3.0"));
  EXPECT_THAT(once, Not(HasSubstr("young")));
}

TEST(SceneDocument, MisspelledKeyNamesPlaceValueAndNearestName) {
  EXPECT_EQ(document_refusal(kBox + "material = { yuong = 2e5 }\n"),
            "beam.toml:3:14: unknown key yuong = 2e+05 in material (did you mean 'young'?)");
  EXPECT_THAT(document_refusal("[tim]\nstep = 1\n" + kBox), AllOf(StartsWith("beam.toml:1:"), HasSubstr("'time'")));
  EXPECT_THAT(document_refusal(kBox + "duration = 3\n"), HasSubstr("belongs to time"));
}

TEST(SceneDocument, WrongTypeNamesExpectedType) {
  EXPECT_EQ(document_refusal("[time]\nstep = \"fast\"\n" + kBox),
            "beam.toml:2:8: step = \"fast\"; this is a string; expected a number [s]");
  EXPECT_THAT(document_refusal("gravity = [0, -9.81]\n" + kBox),
              AllOf(StartsWith("beam.toml:1:11"), HasSubstr("three numbers [m/s^2]")));
  EXPECT_THAT(document_refusal("[solver]\nmax_iterations = 2.5\n" + kBox), HasSubstr("an integer"));
  EXPECT_THAT(document_refusal("[output]\nobj = 1\n" + kBox), HasSubstr("true or false"));
  EXPECT_THAT(document_refusal("time = 1979-05-27\n" + kBox), HasSubstr("date"));
}

TEST(SceneDocument, ValueOutOfRangeNamesRemedy) {
  EXPECT_EQ(document_refusal(kBox + "material = { poisson = 0.5 }\n"),
            "beam.toml:3:24: poisson = 0.5; must be > -1 and < 0.5 (try 0.485)");
  EXPECT_THAT(document_refusal(kBox + "material = { density = 0 }\n"), HasSubstr("must be > 0"));
  EXPECT_THAT(document_refusal(kBox + "material = { density = -5.0 }\n"), HasSubstr("density = -5.0"));
  EXPECT_THAT(document_refusal("[time]\nstep = nan\n" + kBox), HasSubstr("finite"));
  EXPECT_THAT(document_refusal("gravity = [0, inf, 0]\n" + kBox), HasSubstr("finite"));
  EXPECT_THAT(document_refusal("[time]\nstep = 0\n" + kBox),
              HasSubstr("step = 0; must be > 0 and <= 1e+100 (try 0.01)"));
  EXPECT_THAT(document_refusal("[solver]\nline_search = { alpha_max = 1e9 }\n" + kBox), HasSubstr("(try 1e+06)"));
  EXPECT_THAT(document_refusal("[solver]\nline_search = { p = 0.99999 }\n" + kBox), HasSubstr("(try 0.99)"));
  EXPECT_THAT(document_refusal(kBox + "scale = -1\n"), HasSubstr("scale = -1"));
}

TEST(SceneDocument, UnknownChoiceNamesNearest) {
  EXPECT_THAT(document_refusal(kBox + "material = { model = \"neo_hokean\" }\n"),
              HasSubstr("did you mean 'neo_hookean'?"));
  EXPECT_THAT(document_refusal("[time]\nintegrator = \"backward_eular\"\n" + kBox), HasSubstr("'backward_euler'"));
  EXPECT_THAT(document_refusal("[solver]\nmethod = \"newtn\"\n" + kBox), HasSubstr("'newton'"));
}

TEST(SceneDocument, AlternativesExcludeEachOther) {
  EXPECT_THAT(document_refusal(kBox + "material = { young = 1e5, mu = 3 }\n"),
              AllOf(StartsWith("beam.toml:3:"), HasSubstr("mu = 3.0 excludes young"), HasSubstr("lambda, mu")));
  EXPECT_THAT(document_refusal(kBox + "material = { mu = 3 }\n"), HasSubstr("needs the key 'lambda'"));
  EXPECT_THAT(document_refusal(kBox + "material = { mu = 3, lambda = -2 }\n"),
              HasSubstr("lambda = -2; must be > -2/3 mu = -2"));
  EXPECT_THAT(document_refusal(kBox + "mesh = \"a.msh\"\n"), HasSubstr("excludes"));
  EXPECT_THAT(document_refusal("[[body]]\nmesh_size = 1\n"), HasSubstr("needs the key 'mesh'"));
  EXPECT_THAT(document_refusal(kBox + "deform = { hash = \"x\" }\n"), HasSubstr("needs the key 'file'"));
  EXPECT_THAT(document_refusal(kBox + "material = { young = { name = \"E\" } }\n"), HasSubstr("needs the key 'file'"));
  EXPECT_THAT(document_refusal(kBox + "material = { hash = \"x\" }\n"), HasSubstr("needs the key 'file'"));
  EXPECT_THAT(document_refusal("[[body]]\nname = \"a\"\n"), HasSubstr("body needs one of: mesh, mesh_size | shape"));
  EXPECT_THAT(document_refusal(kBox + "[[body.pin]]\nwhere = { lowest = 0.1, highest = 0.1 }\n"),
              HasSubstr("excludes lowest"));
}

TEST(SceneDocument, SeveralErrorsAreReportedTogether) {
  const std::string text = document_refusal("[time]\nstep = -1\nduraton = 3\n" + kBox + "velocity = 1\n");
  EXPECT_THAT(text, AllOf(HasSubstr("beam.toml:2:"), HasSubstr("beam.toml:3:"), HasSubstr("beam.toml:6:")));
}

TEST(SceneDocument, SyntaxErrorsHaveAPlace) {
  EXPECT_THAT(document_refusal("gravity = [0, 0\n"), StartsWith("beam.toml:"));
  EXPECT_THAT(document_refusal("gravity = [0, }\n"), StartsWith("beam.toml:1:15: "));
  EXPECT_THAT(document_refusal("gravity = \n"), StartsWith("beam.toml:1:"));
}

// toml++ lets the compiler assume that these letters cannot occur there.
TEST(SceneDocument, NonAsciiLettersOutsideStringsAreNamed) {
  for (const std::string letter : {"\u00e4", "\u048f", "\u1680", "\u2028", "\U0001f41f"}) {
    EXPECT_THAT(document_refusal(letter + " = 1\n" + kBox), StartsWith("beam.toml:1:")) << letter;
    EXPECT_THAT(document_refusal("[[body" + letter + "]]\n"), StartsWith("beam.toml:1:")) << letter;
  }
}

TEST(SceneDocument, FormulaErrorsHavePlaces) {
  EXPECT_THAT(document_refusal(kBox + "material = { young = \"1e5 * foo\" }\n"),
              AllOf(StartsWith("beam.toml:3:22"), HasSubstr("'foo'")));
  EXPECT_THAT(document_refusal(kBox + "[[body.pin]]\nwhere = \"y >\"\n"), StartsWith("beam.toml:4:9"));
  EXPECT_EQ(document_refusal(kBox + "[[body.pin]]\nwhere = \"y>0\"\nmotion = { displacement = [0, \"sin(t)\", 0] }\n"),
            "");
}

TEST(SceneDocument, NamesAreUniqueAndPlain) {
  EXPECT_THAT(document_refusal(kBox + "name = \"a\"\n" + kBox + "name = \"a\"\n"),
              AllOf(StartsWith("beam.toml:6:"), HasSubstr("taken by beam.toml:3:")));
  EXPECT_THAT(document_refusal(kBox + "name = \"../a\"\n"), HasSubstr("letters, digits"));
  const Table scene = document("[[body]]\nmesh = \"meshes/fat cat.msh\"\n" + kBox);
  EXPECT_EQ(body(scene, 0)["name"].text(), "fat_cat");
  EXPECT_EQ(body(scene, 1)["name"].text(), "body2");
}

TEST(SceneDocument, DegenerateGeometryIsRejected) {
  EXPECT_THAT(document_refusal("[[body]]\nshape = { box = { upper = [1, 0, 1], cells = [1, 1, 1] } }\n"),
              HasSubstr("upper"));
  EXPECT_THAT(document_refusal("[[body]]\nshape = { box = { upper = [1, 1, 1], cells = [1, 1] } }\n"),
              HasSubstr("cells"));
  EXPECT_THAT(document_refusal("[[body]]\nshape = { box = { upper = [1, 1, 1], cells = [1, 0, 1] } }\n"),
              HasSubstr("cells"));
  EXPECT_THAT(document_refusal(kBox + "rotate = { axis = [0, 0, 0], angle_deg = 3 }\n"), HasSubstr("direction"));
  EXPECT_THAT(document_refusal(
                  kBox + "[[body.pin]]\nwhere = \"all\"\nmotion = { keyframes = [{ time = 1, displacement = [0, 0, "
                         "0] }, { time = 1, displacement = [0, 0, 0] }] }\n"),
              HasSubstr("later than the previous one"));
}

TEST(Override, ReplacesValuesAnywhere) {
  const std::string two = kBox + "name = \"a\"\n[[body.pin]]\nname = \"base\"\nwhere = \"y < 0.1\"\n" + kBox;
  const Table scene =
      document(two, {"time.step=0.005", "material.young=2e5", "body.a.material.density = 900",
                     "solver.method=gradient_descent", "body.a.pin.0.motion=fixed", "body.a.pin.base.where=y < 0.5"});
  EXPECT_EQ((*scene.find("time"))["step"].number(), 0.005);
  EXPECT_EQ((*scene.find("solver"))["method"].text(), "gradient_descent");
  EXPECT_EQ(body(scene, 0)["material"]["young"].number(), 2e5);
  EXPECT_EQ(body(scene, 1)["material"]["young"].number(), 2e5);
  EXPECT_EQ(body(scene, 0)["material"]["density"].number(), 900);
  EXPECT_EQ(body(scene, 1)["material"]["density"].number(), 1000);
  EXPECT_EQ(body(scene, 0)["pin"].array()[0]["where"].text(), "y < 0.5");
}

TEST(Override, ReplacesAlternatives) {
  const std::string box = "[[body]]\nshape = { box = { upper = [1, 1, 1], cells = [1, 1, 1] } }\n";
  Table document = read_toml(box, "box.toml");
  apply_override(document, "body.0.shape.sphere={radius=1, size=0.5}");
  const Table& shape = document.find("body")->array()[0]["shape"].table();
  EXPECT_FALSE(shape.find("box"));
  EXPECT_TRUE(shape.find("sphere"));
  apply_override(document, "mesh=bunny.mesh");
  const Table& body = document.find("body")->array()[0].table();
  EXPECT_FALSE(body.find("shape"));
  EXPECT_EQ(body.find("mesh")->text(), "bunny.mesh");
  // Two overrides that exclude each other are an error.
  apply_override(document, "shape={sphere={radius=1, size=0.5}}");
  EXPECT_TRUE(document.find("body")->array()[0].table().find("mesh"));
}

TEST(Override, NumbersNeedNoZerosBesideThePoint) {
  Table document;
  apply_override(document, "time.step=.01");
  apply_override(document, "gravity=[0, -.5, +.25]");
  EXPECT_EQ(document.find("time")->table().find("step")->number(), 0.01);
  EXPECT_EQ(document.find("gravity")->vector()[1], -0.5);
  apply_override(document, "time.step=5.");
  apply_override(document, "time.integrator=2.e");
  EXPECT_EQ(document.find("time")->table().find("step")->number(), 5);
  EXPECT_EQ(document.find("time")->table().find("integrator")->text(), "2.e");
  EXPECT_EQ(spread_assignments({"--start", "-.5,1", "-o"}), (std::vector<std::string>{"--start", "-0.5,1", "-o"}));
  EXPECT_THAT(document_refusal("[time]\nstep = .01\n"), HasSubstr("write digits before and after the point"));
}

TEST(Override, ErrorsNameTheOverride) {
  EXPECT_EQ(document_refusal(kBox, {"material.yuong=2e5"}),
            "--set material.yuong=2e5: unknown key yuong = 2e+05 in material (did you mean 'young'?)");
  EXPECT_THAT(document_refusal(kBox, {"time.step=-1"}), StartsWith("--set time.step=-1: step = -1"));
  EXPECT_THAT(document_refusal(kBox, {"time.step=fast"}),
              StartsWith("--set time.step=fast: step = \"fast\"; this is a string"));
  EXPECT_THAT(document_refusal(kBox, {"tme.step=1"}), HasSubstr("did you mean 'time'?"));
  EXPECT_THAT(document_refusal(kBox, {"integrator=forward_euler"}), HasSubstr("did you mean 'time.integrator'?"));
  EXPECT_THAT(document_refusal(kBox, {"time.step"}), HasSubstr("KEY=VALUE"));
  EXPECT_THAT(document_refusal(kBox, {"time..step=1"}), HasSubstr("empty"));
  EXPECT_THAT(document_refusal(kBox, {"body.buny.scale=2"}), HasSubstr("unknown key or name 'buny'"));
  EXPECT_THAT(document_refusal(kBox, {"body.pin.where=\"y < 0\""}), HasSubstr("no pin"));
  EXPECT_THAT(document_refusal(kBox, {"gravity=[0, 1"}), StartsWith("--set gravity=[0, 1: "));
  EXPECT_THAT(document_refusal(kBox, {"velocity=[Y, 0, 0]"}), HasSubstr("texts in lists and tables need quotes"));
  EXPECT_THAT(document_refusal(kBox, {"time.step="}), HasSubstr("a value is missing after '='"));
  EXPECT_THAT(document_refusal(kBox, {"gravity=[0, 0, 0]\ntime=3"}), StartsWith("--set gravity"));
}

TEST(Override, ErrorsShortenLongTexts) {
  const std::string filler(100'000, 'x');
  const auto expect_short = [](const std::string& override_text) {
    const std::string why = document_refusal(kBox, {override_text});
    EXPECT_THAT(why, StartsWith("--set " + override_text.substr(0, 57) + "...: "));
    EXPECT_LT(why.size(), 1000);
  };
  for (const char* place : {"", "time.", "body.", "time.step.", "body.0.material.", "body.pin."})
    for (const char* value : {"", "=", "=1", "=[1"}) expect_short(place + filler + value);
  for (const char* key : {"time.step", "gravity", "body.0.material", "solver.method"})
    for (const char* quote : {"", "\"", "[", "{"}) expect_short(std::string(key) + "=" + quote + filler);
}

TEST(SceneDocument, MutatedScenesAreReadOrRejected) {
  const std::string scene =
      "gravity = [0, -9.81, 0]\n[time]\nstep = 0.01\n[solver]\nline_search = { p = 0.5 }\n" + kBox +
      "material = { young = \"1e5 * (1 + X)\", poisson = 0.3 }\ndeform = { twist = { axis = [0, 1, 0], angle_deg = 9 } "
      "}\n[[body.pin]]\nwhere = { lowest = 0.03 }\nmotion = { keyframes = [{ time = 0, displacement = [0, 0, 0] }] "
      "}\n[[body.spring]]\nbetween = [[0, 1]]\nstiffness = 3\n";
  const std::string characters = "0123456789.,=[]{}\"' \n-+eabxyz_#\\";
  std::mt19937 random(5);
  int refused = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    std::string text = scene;
    for (unsigned edits = 1 + random() % 4; edits > 0; --edits) {
      const size_t at = random() % text.size();
      const char c = characters[random() % characters.size()];
      if (random() % 3 == 0) {
        text.erase(at, 1 + random() % 6);
      } else if (random() % 2) {
        text.insert(at, 1, c);
      } else {
        text[at] = c;
      }
    }
    refused += !document_refusal(text).empty();  // any other exception ends the test
  }
  EXPECT_GT(refused, 1000);
  EXPECT_LT(refused, 3000);
}

TEST(Schema, EveryKeyHasMeaning) {
  for (const Key& key : scene_schema().keys) {
    EXPECT_FALSE(key.meaning.empty()) << key.section << "." << key.name;
    EXPECT_TRUE(key.fallback.empty() || key.fallback == "{}" || !key.reason.empty()) << key.section << "." << key.name;
  }
}

TEST(Schema, EveryTableHasItsSection) {
  for (const Key& key : scene_schema().keys) {
    if (key.table.empty()) continue;
    EXPECT_FALSE(scene_schema().names(key.table).empty()) << key.section << "." << key.name;
  }
}

TEST(Schema, NoKeyAppearsTwiceInASection) {
  const Schema& schema = scene_schema();
  for (const Key& key : schema.keys) EXPECT_EQ(&key, schema.find(key.section, key.name)) << key.section << key.name;
}

TEST(Schema, AlternativesNameExistingKeys) {
  for (const Alternatives& rule : scene_schema().alternatives)
    for (const auto& group : rule.groups)
      for (const std::string& name : group) EXPECT_TRUE(scene_schema().find(rule.section, name)) << name;
}

TEST(SceneDocument, DeeplyNestedKeysAreRejected) {
  std::string key = "a";
  for (int i = 0; i < 100'000; ++i) key += ".a";
  EXPECT_THAT(document_refusal("[" + key + "]\n"), HasSubstr(":1:1: a key of more than 32 parts"));
  EXPECT_THAT(document_refusal("\n" + key + " = 1\n"), HasSubstr(":2:1: a key of more than 32 parts"));
  EXPECT_THAT(document_refusal("b = { " + key + " = 1 }\n"), HasSubstr("a key of more than 32 parts"));
  const std::string dots(100, '.');
  EXPECT_THAT(document_refusal("# " + dots + "\nnome = \"" + dots + "\"\n"), HasSubstr("unknown key nome"));
}

}  // namespace
}  // namespace aspic
