// Writes the keywords of scenes and data sets for libFuzzer, from the tables that validate them.
#include <set>

#ifdef ASPIC_HAS_FIT
#include "data/capture_schema.h"
#endif
#include "scene/expression.h"
#include "scene/schema.h"
#include "seeds.h"

namespace aspic::fuzz {
namespace {

// Quoted as in a dictionary file.
std::string entry(const std::string& word) {
  std::string text = "\"";
  for (const char c : word)
    if (c == '\n') {
      text += "\\x0a";
    } else {
      text += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
    }
  return text + "\"\n";
}

void add_words(const Schema& schema, std::set<std::string>& words) {
  for (const Key& key : schema.keys) {
    words.insert(key.name + " = ");
    for (const std::string& choice : key.choices) words.insert('"' + choice + '"');
    if (key.accepts & kTable) words.insert(key.name + " = { ");
    const bool is_outer = key.section == "scene" || key.section == "capture";
    if (key.accepts & kTables) words.insert("[[" + (is_outer ? "" : key.section + ".") + key.name + "]]\n");
  }
}

const std::vector<std::string> kToml = {"[time]\n",
                                        "[solver]\n",
                                        "[output]\n",
                                        "\"\"\"",
                                        "'''",
                                        "{}",
                                        "[]",
                                        "1e400",
                                        "1e18",
                                        "-1",
                                        "nan",
                                        "inf",
                                        "0x7fffffff",
                                        "9223372036854775807",
                                        "\\u001b",
                                        "\\u0000",
                                        "1979-05-27T07:32:00Z",
                                        "../",
                                        "/dev/zero",
                                        "\"box.msh\"",
                                        "\"young.csv\"",
                                        "\"material.vtu\"",
                                        "\"skin.obj\"",
                                        "\"skin.pc2\"",
                                        "\"painted.ply\""};

std::string text_of(const std::set<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += entry(word);
  return text;
}

}  // namespace

std::vector<Dictionary> dictionaries() {
  std::set<std::string> formula = {"X", "Y", "Z",     "t",     " && ", " || ", "==", "!=", "<=", ">=",
                                   "?", ":", "1e308", "1e400", "0x1",  "^",    "!",  "--", "(",  ")"};
  for (const NamedMeaning& function : expression_functions()) formula.insert(function.name + "(");
  for (const NamedMeaning& constant : expression_constants()) formula.insert(constant.name);
  std::set<std::string> scene(kToml.begin(), kToml.end());
  std::set<std::string> capture = scene;
  add_words(scene_schema(), scene);
#ifdef ASPIC_HAS_FIT
  add_words(capture_schema(), capture);
#endif
  return {{"scene", text_of(scene)},
          {"toml", text_of(scene)},
          {"overrides", text_of(scene)},
          {"data_set", text_of(capture)},
          {"expression", text_of(formula)}};
}

}  // namespace aspic::fuzz
