#include "scene/toml_reader.h"

// toml++ 3.3 asserts that "[1, }" cannot be (in a release build it tells the compiler so) and then reports it as the
// error that it is. Input must not end the program, so its assertions are off in every build.
#undef NDEBUG
#define TOML_ASSERT(condition) static_cast<void>(0)
#include <toml++/toml.h>

#include <algorithm>
#include <cctype>

#include "base/error.h"

namespace aspic {
namespace {

using Source = std::shared_ptr<const std::string>;

Place place_of(const toml::source_region& region, const Source& source) {
  return {source, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

Value convert(const toml::node& node, const Source& source) {
  Value value;
  value.place = place_of(node.source(), source);
  if (const auto* b = node.as_boolean()) {
    value.data = b->get();
  } else if (const auto* i = node.as_integer()) {
    value.data = i->get();
  } else if (const auto* d = node.as_floating_point()) {
    value.data = d->get();
  } else if (const auto* s = node.as_string()) {
    value.data = s->get();
  } else if (const auto* a = node.as_array()) {
    Array array;
    for (const toml::node& element : *a) array.push_back(convert(element, source));
    value.data = std::move(array);
  } else if (const auto* t = node.as_table()) {
    Table table;
    for (const auto& [key, element] : *t)
      table.members.push_back({std::string(key.str()), place_of(key.source(), source), convert(element, source)});
    // The library sorts by name; a message about several keys should follow the document.
    const auto earlier = [](const Member& one, const Member& other) {
      return std::pair(one.place.line, one.place.column) < std::pair(other.place.line, other.place.column);
    };
    std::stable_sort(table.members.begin(), table.members.end(), earlier);
    value.data = std::move(table);
  } else {
    throw InvalidInput(to_string(value.place) + ": a date or time has no use in a scene; write a number or a string");
  }
  return value;
}

// The library follows the parts of a.b.c by recursion, as far as the stack reaches. Texts and comments are passed over.
void check_depth_of_keys(std::string_view text, const Source& source) {
  constexpr int kDeepest = 32;
  int line = 1, dots = 0;
  char quote = 0;
  const auto continues_key = [](char c) {
    return c == ' ' || c == '\t' || c == '_' || c == '-' || std::isalnum(static_cast<unsigned char>(c)) != 0;
  };
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\n') {
      ++line, dots = 0, quote = 0;
    } else if (quote != 0) {
      if (c == '\\' && quote == '"') ++i;
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '#') {
      i = std::min(text.find('\n', i), text.size()) - 1;
    } else if (c == '.') {
      if (++dots > kDeepest)
        throw InvalidInput(to_string(Place{source, line, 1}) + ": a key of more than " + std::to_string(kDeepest) +
                           " parts; nothing here is nested so deeply");
    } else if (!continues_key(c)) {
      dots = 0;
    }
  }
}

void forget_lines(Value& value) {
  value.place.line = value.place.column = 0;
  if (value.is_array())
    for (Value& v : value.array()) forget_lines(v);
  if (value.is_table())
    for (Member& m : value.table().members) m.place.line = m.place.column = 0, forget_lines(m.value);
}

}  // namespace

Table read_toml(const std::string& text, const std::string& source) {
  const auto name = std::make_shared<const std::string>(source);
  check_depth_of_keys(text, name);
  try {
    const toml::table document = toml::parse(text, source);
    return std::move(convert(document, name).table());
  } catch (const toml::parse_error& e) {
    throw InvalidInput(to_string(place_of(e.source(), name)) + ": " + std::string(e.description()));
  }
}

Value read_toml_value(const std::string& text, const std::string& source) {
  Table table;
  try {
    table = read_toml("value = " + text, source);
  } catch (const InvalidInput& e) {
    const std::string reason = e.what();
    const size_t start = reason.find(": ", source.size());
    throw InvalidInput(source + ": " + (start == std::string::npos ? reason : reason.substr(start + 2)) +
                       " (texts in lists and tables need quotes: --set 'velocity=[\"Y\", 0, 0]')");
  }
  if (table.members.size() != 1) throw InvalidInput(source + ": one value is expected");
  Value value = std::move(table.members.front().value);
  forget_lines(value);
  return value;
}

}  // namespace aspic
