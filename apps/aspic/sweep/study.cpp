#include "aspic/sweep/study.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "aspic/sweep/study_draws.h"
#include "base/error.h"
#include "base/formatted.h"
#include "base/printable.h"
#include "io/csv_reader.h"
#include "scene/scene_document.h"
#include "scene/schema_table.h"
#include "scene/toml_reader.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;

const Schema& study_schema() {
  static const Schema schema = [] {
    const Range counts{.min = 2, .max = kMaxCases};
    Schema s;
    add_section(s, {"study", "*.toml", "The cases of a study."},
                {key("scene", kText, "scene that all cases vary", kRequired),
                 key("vary", kAnyTable, "keys of the scene and their values"),
                 key("sample", kTable, "draws from ranges without count", Members{"sample"}),
                 key("cases", kText, "table with one case per row"),
                 key("frames", kBoolean, "whether the runs write frames and reports", Usual{"false"}),
                 key("threads", kInteger, "threads of each run", Range{.min = 1, .max = 1024}, Usual{"1"})});
    s.alternatives.push_back({"study", {{"vary", "sample"}, {"cases"}}, true});
    add_section(
        s, {"sample", "sample = { ... }", "Draws."},
        {key("method", kText, "how to draw", Choices{{"latin_hypercube", "random"}}, Usual{"\"latin_hypercube\""}),
         key("count", kInteger, "number of draws", counts, kRequired),
         key("seed", kInteger, "seed of the draws", kNotNegative, Usual{"1"})});
    add_section(s, {"holder", "", ""}, {key("range", kTable, "", Members{"range"})});
    add_section(s, {"range", "KEY = { ... } in [vary]", "A range."},
                {key("from", kNumber, "lower end", kRequired), key("to", kNumber, "upper end", kRequired),
                 key("count", kInteger, "number of values of the grid", counts),
                 key("scale", kText, "spacing", Choices{{"linear", "log"}}, Usual{"\"linear\""})});
    return s;
  }();
  return schema;
}

// The values of one key: a list, or a range to draw from.
struct Variation {
  std::string key;
  Place place;
  std::vector<std::string> values;
  std::optional<StudyRange> drawn;
};

// Whole numbers have no point, so that they fit keys that accept integers.
std::string value_text(double value) {
  constexpr double kLargest = 1e15;
  const bool is_whole = value == std::floor(value) && std::abs(value) < kLargest;
  return is_whole ? formatted("%.0f", value) : number_text(value);
}

// Strings have no quotes where --set reads them as strings without quotes.
std::string value_text(const Value& value) {
  if (!value.is_text()) return inline_toml(value);
  const std::string& text = value.text();
  const bool is_edged = text.empty() || text.front() == ' ' || text.back() == ' ';
  if (is_edged || text.find_first_of("\"'[{\t") == 0 || !is_printable(text)) return inline_toml(value);
  try {
    read_toml_value(text, "");
  } catch (const InvalidInput&) {
    return text;
  }
  return inline_toml(value);  // a number or true without quotes
}

bool is_range(const Table& table) {
  const auto is_number = [&](const char* key) { return table.find(key) && table.find(key)->is_number(); };
  return is_number("from") || is_number("to") || table.find("count");
}

std::vector<std::string> overrides_of(const std::vector<std::string>& keys, const std::vector<std::string>& values) {
  std::vector<std::string> texts;
  for (size_t k = 0; k < keys.size(); ++k)
    if (!values[k].empty()) texts.push_back(keys[k] + "=" + values[k]);
  return texts;
}

class StudyReader {
 public:
  explicit StudyReader(const fs::path& path) : path_(path), document_(read_toml(read_toml_text(path), path.string())) {}

  Study read() {
    if (Value* vary = document_.find("vary"); vary && vary->is_table()) {
      collect(vary->table(), "");
      if (variations_.empty()) throw error_at(vary->place, "[vary] is empty; for example material.young = [1e4, 1e5]");
      vary->table().members.clear();  // its keys are those of scenes
    }
    check_and_complete(document_, path_.string(), study_schema(), "study");
    study_.frames = document_.find("frames")->boolean();
    study_.threads = document_.find("threads")->integer();
    read_scene();
    if (const Value* table = document_.find("cases")) {
      read_table(*table);
    } else {
      combine();
    }
    return std::move(study_);
  }

 private:
  void collect(const Table& table, const std::string& path) {
    for (const Member& m : table.members) {
      const std::string key = path + m.key;
      if (m.value.is_table() && !is_range(m.value.table())) {
        collect(m.value.table(), key + ".");
        continue;
      }
      for (const Variation& earlier : variations_)
        if (earlier.key == key) throw error_at(m.place, key + " varies already at " + to_string(earlier.place));
      variations_.push_back({key, m.place, {}, {}});
      if (m.value.is_table()) {
        read_range(m.value, variations_.back());
      } else {
        read_list(m.value, variations_.back());
      }
    }
  }

  static void read_list(const Value& list, Variation& variation) {
    const auto fail = [&](const std::string& reason) {
      throw error_at(list.place, variation.key + " = " + shortened(inline_toml(list)) + "; " + reason);
    };
    if (!list.is_array()) fail("needs a list such as [1, 2] or a range such as { from = 1, to = 2, count = 5 }");
    if (list.array().empty()) fail("at least one value is needed");
    for (const Value& value : list.array()) {
      if (value.is_text() && !is_printable(value.text())) fail("values must be UTF-8 without control characters");
      variation.values.push_back(value_text(value));
    }
  }

  void read_range(const Value& given, Variation& variation) const {
    Table holder;
    holder.set("range", given);
    check_and_complete(holder, path_.string(), study_schema(), "holder");
    const Value& range = *holder.find("range");
    const bool is_log = range["scale"].text() == "log";
    const double from = range["from"].number(), to = range["to"].number();
    if (is_log && !(from > 0))
      throw error_at(range["from"].place, "from = " + number_text(from) + "; must be > 0 with scale = \"log\"");
    if (!(from < to))
      throw error_at(range["to"].place, "to = " + number_text(to) + "; must be above from = " + number_text(from));
    const StudyRange values{from, to, is_log ? StudyScale::logarithmic : StudyScale::linear};
    if (const Value* count = range.find("count")) {
      for (const double value : values.grid(count->integer())) variation.values.push_back(value_text(value));
    } else {
      variation.drawn = values;
    }
  }

  void read_scene() {
    const Value& scene = *document_.find("scene");
    std::error_code error;
    study_.scene = path_.parent_path() / scene.text();
    if (const fs::path plain = study_.scene.lexically_normal(); fs::equivalent(plain, study_.scene, error))
      study_.scene = plain;
    if (study_.scene.extension() != ".toml" || !fs::is_regular_file(study_.scene, error))
      throw error_at(scene.place, "scene = " + toml_string(scene.text()) + "; " + printable(study_.scene.string()) +
                                      (study_.scene.extension() != ".toml" ? " is no .toml file" : " does not exist") +
                                      " (the path is relative to the study)");
    text_ = read_toml_text(study_.scene);
    read_scene_document(text_, study_.scene.string());
  }

  // Lists and grids form the product; the draws repeat for each of its members.
  void combine() {
    const Value* sample = document_.find("sample");
    const int draws = sample ? (*sample)["count"].integer() : 1;
    double count = draws;
    for (Variation& v : variations_) {
      study_.keys.push_back(v.key);
      if (v.drawn && !sample)
        throw error_at(v.place, v.key +
                                    " has a range without count; add count = 5, or sample = { count = 100 } at the "
                                    "top of the study to draw from it");
      if (!v.drawn) count *= static_cast<double>(v.values.size());
    }
    if (sample && std::none_of(variations_.begin(), variations_.end(), [](const Variation& v) { return v.drawn; }))
      throw error_at(sample->place, "sample has nothing to draw; remove it, or remove count from a range of [vary]");
    if (count > kMaxCases)
      throw error_at(document_.find("vary")->place, formatted("%.0f cases; at most %d are supported (fewer values, or "
                                                              "sample from ranges)",
                                                              count, kMaxCases));
    for (Variation& v : variations_)
      if (v.drawn && sample) draw(*sample, v);
    for (size_t i = 0; i < static_cast<size_t>(count); ++i) study_.cases.push_back(member(i, draws));
    for (size_t k = 0; k < variations_.size(); ++k) check_values(k);
  }

  static void draw(const Value& sample, Variation& variation) {
    const Draws draws(static_cast<std::uint64_t>(sample["seed"].number()), variation.key);
    const int count = sample["count"].integer();
    const bool is_random = sample["method"].text() == "random";
    for (const double share : is_random ? random_sample(draws, count) : latin_hypercube(draws, count))
      variation.values.push_back(value_text(variation.drawn->at(share)));
  }

  // The draw varies fastest, then the last key.
  std::vector<std::string> member(size_t index, int draws) const {
    std::vector<std::string> values(variations_.size());
    const size_t draw = index % draws;
    index /= draws;
    for (size_t k = variations_.size(); k-- > 0;) {
      const Variation& v = variations_[k];
      values[k] = v.values[v.drawn ? draw : index % v.values.size()];
      if (!v.drawn) index /= v.values.size();
    }
    return values;
  }

  // Ranges of the schema are intervals, so the ends and one value between them represent a range.
  void check_values(size_t k) const {
    const Variation& v = variations_[k];
    std::vector<std::string> values = v.values;
    if (v.drawn) values = {value_text(v.drawn->from), value_text(v.drawn->to), v.values.front()};
    for (const std::string& value : values) {
      std::vector<std::string> first_case = study_.cases.front();
      first_case[k] = value;
      check_case(first_case, k, [&](size_t key) { return to_string(variations_[key].place); });
    }
  }

  // Replaces the place "--set KEY=VALUE" in messages by `place_of` the key; other messages get the place of key `k`.
  template <class PlaceOf>
  void check_case(const std::vector<std::string>& values, size_t k, const PlaceOf& place_of) const {
    try {
      read_scene_document(text_, study_.scene.string(), overrides_of(study_.keys, values));
    } catch (const InvalidInput& e) {
      std::string reason = e.what();
      reason = reason.substr(0, reason.find('\n'));
      for (size_t key = 0; key < values.size(); ++key) {
        const std::string source = "--set " + shortened(study_.keys[key] + "=" + values[key]) + ": ";
        if (reason.starts_with(source)) reason = reason.substr(source.size()), k = key;
      }
      throw InvalidInput(place_of(k) + ": " + shortened(study_.keys[k] + "=" + values[k]) + ": " + reason);
    }
  }

  void read_table(const Value& table) {
    const fs::path file = path_.parent_path() / table.text();
    std::error_code error;
    if (!fs::is_regular_file(file, error))
      throw error_at(table.place, "cases = " + toml_string(table.text()) + "; " + printable(file.string()) +
                                      " does not exist (the path is relative to the study)");
    CsvReader rows(file, CsvOrigin::foreign);
    std::vector<size_t> columns;
    for (size_t c = 0; c < rows.columns().size(); ++c) {
      const std::string& name = rows.columns()[c];
      if (name == "case") continue;  // the number of the case in tables that Aspic writes
      if (std::find(study_.keys.begin(), study_.keys.end(), name) != study_.keys.end())
        throw InvalidInput(file.string() + ":1: the column " + shown(name) + " occurs twice");
      study_.keys.push_back(name);
      columns.push_back(c);
    }
    if (columns.empty())
      throw InvalidInput(file.string() + ":1: no column is a key of the scene, such as material.young");
    while (rows.next()) {
      if (study_.cases.size() == kMaxCases)
        throw InvalidInput(rows.where() + ": more than " + std::to_string(kMaxCases) + " cases; divide the table");
      std::vector<std::string>& values = study_.cases.emplace_back();
      for (const size_t c : columns) values.push_back(rows.text(c));
      check_case(values, 0, [&](size_t) { return rows.where(); });
    }
    if (study_.cases.empty()) throw InvalidInput(file.string() + ": has no rows; each row is a case");
  }

  fs::path path_;
  Table document_;
  std::string text_;  // of the scene
  std::vector<Variation> variations_;
  Study study_;
};

}  // namespace

std::vector<std::string> Study::overrides(size_t index) const { return overrides_of(keys, cases[index]); }

Study read_study(const fs::path& path) { return StudyReader(path).read(); }

}  // namespace aspic
