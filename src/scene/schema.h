// All keys of scenes in one table: the source of validation, defaults and docs/scene.md.
#pragma once
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "scene/value.h"

namespace aspic {

enum Accepts : unsigned {
  kNumber = 1,
  kInteger = 2,
  kBoolean = 4,
  kText = 8,          // a string; one of `choices` if there are any
  kExpression = 16,   // a string: a formula of X, Y, Z
  kNumbers = 32,      // three numbers
  kExpressions = 64,  // three numbers or formulas
  kIntegers = 128,    // a list of integers of any length
  kMatrix = 256,      // three rows of three numbers
  kPairs = 512,       // a list of pairs of integers
  kTable = 1024,
  kTables = 2048,             // [[...]], or a single table
  kAnyTable = 4096,           // keys are chosen by the user; all values are numbers
  kMovingExpressions = 8192,  // three numbers or formulas of X, Y, Z and t
  kNames = 16384,             // a list of any length of `choices`
  kMovingExpression = 32768,  // a string: a formula of X, Y, Z and t
  kTwoNumbers = 65536
};

struct Range {
  double min = -std::numeric_limits<double>::infinity(), max = std::numeric_limits<double>::infinity();
  bool min_open = false, max_open = false;

  bool contains(double value) const;
  std::string text() const;  // "> 0 and < 0.5"; empty for all numbers
  // Suggests a value: "try 0.49". Below the range it suggests `usual`, unless that is empty.
  std::string remedy(double value, const std::string& usual) const;
};

struct Key {
  std::string section = {}, name = {};
  unsigned accepts = 0;
  std::string unit = {};      // "" for a pure number or no number
  std::string fallback = {};  // the default as TOML; empty: none
  bool required = false;      // in a group of alternatives: if that group is chosen
  Range range = {};
  std::vector<std::string> choices = {};
  std::string table = {};  // the section of the keys of a table or of a list of tables
  std::string meaning = {}, reason = {};
};

struct Section {
  std::string name;   // "material"
  std::string where;  // how it appears in a file: "material = { ... } of a [[body]]"
  std::string about;
};

// At most one of the groups may be given. The defaults of a group apply if it is chosen; those of the first group also
// if none is.
struct Alternatives {
  std::string section;
  std::vector<std::vector<std::string>> groups;
  bool required = false;
};

struct Schema {
  std::vector<Section> sections;
  std::vector<Key> keys;
  std::vector<Alternatives> alternatives;

  const Key* find(std::string_view section, std::string_view name) const;
  const Key& key(std::string_view section, std::string_view name) const;  // requires that the key exists
  std::vector<std::string> names(std::string_view section) const;
  const Alternatives* alternatives_of(std::string_view section) const;
};

const Schema& scene_schema();

// Checks a document against the schema and fills in the defaults, in the order of the schema. Integers become floats
// where a float is expected. Throws InvalidInput with the first few errors, one per line.
void check_and_complete(Table& document, const std::string& source);
// The same for another kind of document, whose keys are those of `section`.
void check_and_complete(Table& document, const std::string& source, const Schema& schema, const std::string& section);

// Sorts the members of a checked document at every level into the order of the schema.
void put_in_order(Table& table, std::string_view section = "scene");

}  // namespace aspic
