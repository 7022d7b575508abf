// A TOML document as a tree of values with their places in the source.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/error.h"
#include "base/formatted.h"
#include "base/printable.h"
#include "math/small.h"

namespace aspic {

struct Place {
  std::shared_ptr<const std::string> source;  // a file name, or "--set time.step=0"; empty for a default
  int line = 0, column = 0;                   // from 1; 0: the source has no lines

  bool is_override() const { return source && line == 0; }
};
std::string to_string(const Place& place);  // "beam.toml:12:3"
InvalidInput error_at(const Place& place, const std::string& reason);

struct Value;
struct Member;
using Array = std::vector<Value>;

struct Table {
  std::vector<Member> members;  // in the order of the document, or of the schema once checked

  const Value* find(std::string_view key) const;
  Value* find(std::string_view key);
  void set(std::string_view key, Value value);  // replaces or appends
};

struct Value {
  std::variant<bool, std::int64_t, double, std::string, Array, Table> data;  // false
  Place place;

  bool is_table() const { return std::holds_alternative<Table>(data); }
  bool is_array() const { return std::holds_alternative<Array>(data); }
  bool is_text() const { return std::holds_alternative<std::string>(data); }
  bool is_number() const { return std::holds_alternative<double>(data) || std::holds_alternative<std::int64_t>(data); }

  // Require a checked value of this type.
  bool boolean() const { return std::get<bool>(data); }
  double number() const;
  int integer() const { return static_cast<int>(std::get<std::int64_t>(data)); }
  const std::string& text() const { return std::get<std::string>(data); }
  const Array& array() const { return std::get<Array>(data); }
  const Table& table() const { return std::get<Table>(data); }
  Array& array() { return std::get<Array>(data); }
  Table& table() { return std::get<Table>(data); }
  Vec3d vector() const;  // of an array of three numbers

  const Value* find(std::string_view key) const { return table().find(key); }
  const Value& operator[](std::string_view key) const;  // requires a checked table with this key
};

struct Member {
  std::string key;
  Place place;  // of the key
  Value value;
};

// Returns whether the user gave the key: it is not a default.
bool is_given(const Table& table, std::string_view key);
void erase(Table& table, std::string_view key);

// Returns the shortest text that reads back to the same bits, in any locale.
std::string number_text(double value);
std::string point_text(const Vec3d& X);          // "(0.5, 1, 0)"
std::string toml_string(std::string_view text);  // a TOML string
std::string inline_toml(const Value& value);
std::string type_name(const Value& value);  // "a number"

// Returns the document as TOML, with [tables] at the top level and [[tables]] for arrays of tables.
std::string to_toml(const Table& document);

}  // namespace aspic
