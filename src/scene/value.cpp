#include "scene/value.h"

#include <cmath>
#include <utility>

#include "base/check.h"
#include "base/number_chars.h"

namespace aspic {
namespace {

bool is_bare_key(std::string_view key) {
  if (key.empty()) return false;
  for (const char c : key)
    if (!((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-'))
      return false;
  return true;
}

std::string key_text(std::string_view key) { return is_bare_key(key) ? std::string(key) : toml_string(key); }

bool is_array_of_tables(const Value& value) {
  return value.is_array() && !value.array().empty() && value.array().front().is_table();
}

// Tables of these levels have a header; deeper ones are inline.
void append_tables(const Table& table, const std::string& prefix, std::string& out) {
  for (const Member& m : table.members) {
    const std::string path = prefix + key_text(m.key);
    if (is_array_of_tables(m.value)) {
      for (const Value& element : m.value.array()) {
        out.append("\n[[").append(path).append("]]\n");
        for (const Member& e : element.table().members)
          if (!is_array_of_tables(e.value)) out += key_text(e.key) + " = " + inline_toml(e.value) + "\n";
        append_tables(element.table(), path + ".", out);
      }
    } else if (m.value.is_table() && prefix.empty()) {
      out.append("\n[").append(path).append("]\n");
      for (const Member& e : m.value.table().members) out += key_text(e.key) + " = " + inline_toml(e.value) + "\n";
    }
  }
}

}  // namespace

std::string to_string(const Place& place) {
  if (!place.source) return "default";
  if (place.line == 0) return *place.source;
  return *place.source + ":" + std::to_string(place.line) + ":" + std::to_string(place.column);
}

InvalidInput error_at(const Place& place, const std::string& reason) {
  return InvalidInput(to_string(place) + ": " + reason);
}

const Value* Table::find(std::string_view key) const {
  for (const Member& m : members)
    if (m.key == key) return &m.value;
  return nullptr;
}

Value* Table::find(std::string_view key) { return const_cast<Value*>(std::as_const(*this).find(key)); }

bool is_given(const Table& table, std::string_view key) {
  for (const Member& m : table.members)
    if (m.key == key) return m.place.source != nullptr;
  return false;
}

void erase(Table& table, std::string_view key) {
  std::erase_if(table.members, [&](const Member& m) { return m.key == key; });
}

void Table::set(std::string_view key, Value value) {
  const Place place = value.place;
  for (Member& m : members) {
    if (m.key != key) continue;
    m.place = place;
    m.value = std::move(value);
    return;
  }
  members.push_back({std::string(key), place, std::move(value)});
}

double Value::number() const {
  const std::int64_t* whole = std::get_if<std::int64_t>(&data);
  return whole ? static_cast<double>(*whole) : std::get<double>(data);
}

Vec3d Value::vector() const {
  const Array& a = array();
  ASPIC_CHECK(a.size() == 3);
  return {{a[0].number(), a[1].number(), a[2].number()}};
}

const Value& Value::operator[](std::string_view key) const {
  const Value* value = find(key);
  ASPIC_CHECK(value);
  return *value;
}

std::string number_text(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  char buffer[40];
  const auto end = to_chars(buffer, buffer + sizeof buffer, value).ptr;
  return std::string(buffer, end);
}

std::string point_text(const Vec3d& X) {
  return std::string("(").append(number_text(X[0])) + ", " + number_text(X[1]) + ", " + number_text(X[2]) + ")";
}

std::string toml_string(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += {'\\', c};
    } else if (c == '\n') {
      out += "\\n";
    } else if (c == '\t') {
      out += "\\t";
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      const char* digits = "0123456789ABCDEF";
      out += std::string("\\u00") + digits[(c >> 4) & 15] + digits[c & 15];
    } else {
      out += c;
    }
  }
  return out + "\"";
}

std::string inline_toml(const Value& value) {
  if (const bool* b = std::get_if<bool>(&value.data)) return *b ? "true" : "false";
  if (const std::int64_t* i = std::get_if<std::int64_t>(&value.data)) return std::to_string(*i);
  if (const double* d = std::get_if<double>(&value.data)) {
    const std::string text = number_text(*d);
    return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;  // a float stays a float
  }
  if (value.is_text()) return toml_string(value.text());
  std::string out;
  if (value.is_array()) {
    for (const Value& v : value.array()) out += (out.empty() ? "[" : ", ") + inline_toml(v);
    return out.empty() ? "[]" : out + "]";
  }
  for (const Member& m : value.table().members)
    out += (out.empty() ? "{ " : ", ") + key_text(m.key) + " = " + inline_toml(m.value);
  return out.empty() ? "{}" : out + " }";
}

std::string type_name(const Value& value) {
  const char* names[] = {"a boolean", "an integer", "a number", "a string", "an array", "a table"};
  return names[value.data.index()];
}

std::string to_toml(const Table& document) {
  std::string out;
  for (const Member& m : document.members)
    if (!m.value.is_table() && !is_array_of_tables(m.value))
      out += key_text(m.key) + " = " + inline_toml(m.value) + "\n";
  append_tables(document, "", out);
  return out;
}

}  // namespace aspic
