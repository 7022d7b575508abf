#include "scene/overrides.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "base/error.h"
#include "base/number_chars.h"
#include "base/printable.h"
#include "scene/schema.h"
#include "scene/toml_reader.h"

namespace aspic {
namespace {

std::string trimmed(const std::string& text) {
  const size_t first = text.find_first_not_of(" \t"), last = text.find_last_not_of(" \t");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

std::vector<std::string> key_words(const std::string& path) {
  std::vector<std::string> words;
  size_t begin = 0;
  while (true) {
    const size_t dot = path.find('.', begin);
    words.push_back(trimmed(path.substr(begin, dot - begin)));
    if (dot == std::string::npos) return words;
    begin = dot + 1;
  }
}

Value value_of(const std::string& text, const std::string& source) {
  try {
    return read_toml_value(text, source);
  } catch (const InvalidInput&) {
    if (const std::string spelled = with_zeros_beside_points(text); spelled != text) {
      if (Value number = value_of(spelled, source); !number.is_text()) return number;
    }
    if (text.find_first_of("\"'[{") == 0) throw;
    return {text, {std::make_shared<const std::string>(source), 0, 0}};  // a bare word or formula
  }
}

// A key of the command line replaces its alternatives in the document: a mesh replaces a shape, a sphere a box, a
// material's file its numbers.
void drop_alternatives(Table& table, const std::string& section, const std::string& chosen) {
  const Alternatives* alternatives = scene_schema().alternatives_of(section);
  if (!alternatives) return;
  const auto has = [&](const std::vector<std::string>& group, const std::string& key) {
    return std::find(group.begin(), group.end(), key) != group.end();
  };
  const auto& groups = alternatives->groups;
  const auto own = std::find_if(groups.begin(), groups.end(), [&](const auto& group) { return has(group, chosen); });
  if (own == groups.end()) return;
  std::erase_if(table.members, [&](const Member& member) {
    const bool other = std::any_of(groups.begin(), groups.end(), [&](const auto& g) { return has(g, member.key); });
    return other && !has(*own, member.key) && !member.place.is_override();
  });
}

struct Assignment {
  std::vector<std::string> words;
  Value value;

  [[noreturn]] void fail(const std::string& reason) const { throw error_at(value.place, reason); }

  void apply_to(Table& table, const std::string& section, size_t i) const {
    const Key* key = scene_schema().find(section, words[i]);
    if (i + 1 == words.size()) {
      table.set(words[i], value);  // an unknown key is reported with all the others
      drop_alternatives(table, section, words[i]);
    } else if (key && (key->accepts & kTables)) {
      apply_to_list(table, *key, i);
    } else if (key && (key->accepts & (kTable | kAnyTable))) {
      Value* inner = table.find(words[i]);
      if (!inner || !inner->is_table()) table.set(words[i], {Table{}, value.place});
      apply_to(table.find(words[i])->table(), key->table, i + 1);
    } else {
      const std::vector<std::string> known = scene_schema().names(section);
      fail(key ? shown(words[i]) + " has no keys of its own"
               : "unknown key " + shown(words[i]) + " in " + section + suggestion(words[i], known));
    }
  }

  void apply_to_list(Table& table, const Key& key, size_t i) const {
    Value* list = table.find(key.name);
    if (!list || !(list->is_array() || list->is_table())) fail("the scene has no " + key.name);
    if (list->is_table()) return apply_to(list->table(), key.table, i + 1);
    bool picked = false;
    for (size_t k = 0; k < list->array().size(); ++k) {
      Value& element = list->array()[k];
      const bool is_meant =
          element.is_table() && (name_of(element.table(), key, k) == words[i + 1] || std::to_string(k) == words[i + 1]);
      if (!is_meant) continue;
      if (i + 2 >= words.size()) fail("a key of " + shortened(words[i + 1]) + " is missing");
      apply_to(element.table(), key.table, i + 2);
      picked = true;
    }
    if (picked) return;
    if (!scene_schema().find(key.table, words[i + 1])) fail_unknown_element(*list, key, words[i + 1]);
    for (Value& element : list->array())
      if (element.is_table()) apply_to(element.table(), key.table, i + 1);
  }

  std::string name_of(const Table& element, const Key& key, size_t index) const {
    if (key.name == "body") return body_name(element, index);
    const Value* name = element.find("name");
    return name && name->is_text() ? name->text() : std::to_string(index);
  }

  [[noreturn]] void fail_unknown_element(const Value& list, const Key& key, const std::string& word) const {
    std::vector<std::string> known = scene_schema().names(key.table);
    for (size_t k = 0; k < list.array().size(); ++k)
      if (list.array()[k].is_table()) known.push_back(name_of(list.array()[k].table(), key, k));
    fail("unknown key or name " + shown(word) + " of " + key.name + suggestion(word, known));
  }
};

// Suggests time.step for "step".
std::string unknown_first_word(const std::string& word) {
  const Schema& schema = scene_schema();
  for (const char* section : {"time", "solver", "output", "material", "damping"})
    if (schema.find(section, word))
      return std::string("unknown key '").append(word).append("' (did you mean '").append(section) + "." + word + "'?)";
  std::vector<std::string> known = schema.names("scene");
  for (const std::string& name : schema.names("body")) known.push_back(name);
  return "unknown key " + shown(word) + suggestion(word, known);
}

bool is_assignment(const std::string& text) {
  const size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || text[0] == '-') return false;
  const auto fits = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' ||
           c == '.';
  };
  std::error_code error;
  return std::all_of(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(equals), fits) &&
         !std::filesystem::exists(text, error);
}

}  // namespace

std::vector<std::string> spread_assignments(const std::vector<std::string>& arguments) {
  std::vector<std::string> result;
  bool follows_one = false;  // follows --set KEY=VALUE
  for (size_t i = 0; i < arguments.size(); ++i) {
    if (follows_one && is_assignment(arguments[i])) result.emplace_back("--set");
    const bool is_value = i > 0 && arguments[i - 1] == "--set";
    follows_one = is_value || arguments[i].starts_with("--set=") || (follows_one && is_assignment(arguments[i]));
    result.push_back(arguments[i].starts_with("-.") ? with_zeros_beside_points(arguments[i]) : arguments[i]);
  }
  return result;
}

void apply_override(Table& document, const std::string& text) {
  const std::string source = "--set " + shortened(text);
  const size_t equals = text.find('=');
  if (equals == std::string::npos) throw InvalidInput(source + ": KEY=VALUE is expected, for example time.step=0.005");
  if (trimmed(text.substr(equals + 1)).empty())
    throw InvalidInput(source + ": a value is missing after '=', for example time.step=0.005");
  Assignment assignment{key_words(text.substr(0, equals)), value_of(trimmed(text.substr(equals + 1)), source)};
  if (std::count(assignment.words.begin(), assignment.words.end(), "") > 0)
    throw InvalidInput(source + ": a key is empty");
  const Schema& schema = scene_schema();
  const std::string& first = assignment.words.front();
  if (!schema.find("scene", first)) {
    if (!schema.find("body", first)) assignment.fail(unknown_first_word(first));
    assignment.words.insert(assignment.words.begin(), "body");
  }
  assignment.apply_to(document, "scene", 0);
}

std::string body_name(const Table& body, size_t index) {
  if (const Value* name = body.find("name"); name && name->is_text()) return name->text();
  if (const Value* mesh = body.find("mesh"); mesh && mesh->is_text()) {
    std::string stem = std::filesystem::path(mesh->text()).stem().string();
    for (char& c : stem)
      if (!((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-')) c = '_';
    if (!stem.empty()) return stem;
  }
  return "body" + std::to_string(index + 1);
}

}  // namespace aspic
