// The three parts of the table behind scene_schema().
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "scene/schema.h"

namespace aspic {

inline const Range kPositive{.min = 0, .min_open = true};
inline const Range kNotNegative{.min = 0};

// Details of a key, in any order after its name, type and meaning.
struct Units {
  std::string name;
};
struct Choices {
  std::vector<std::string> names;
};
struct Members {
  std::string section;  // keys of the table, or of each table of the list
};
struct Required {};
inline constexpr Required kRequired;
struct Usual {
  std::string fallback, reason = {};
};

inline void add_detail(Key& key, Units unit) { key.unit = std::move(unit.name); }
inline void add_detail(Key& key, const Range& range) { key.range = range; }
inline void add_detail(Key& key, Choices choices) { key.choices = std::move(choices.names); }
inline void add_detail(Key& key, Members members) { key.table = std::move(members.section); }
inline void add_detail(Key& key, Required) { key.required = true; }
inline void add_detail(Key& key, Usual usual) {
  key.fallback = std::move(usual.fallback), key.reason = std::move(usual.reason);
}

// key("step", kNumber, "time step h", Units{"s"}, kPositive, Usual{"0.01", "resolves motions of a few hertz"})
template <class... Details>
Key key(std::string name, unsigned accepts, std::string meaning, Details... details) {
  Key key{.name = std::move(name), .accepts = accepts, .meaning = std::move(meaning)};
  (add_detail(key, std::move(details)), ...);
  return key;
}

inline void add_keys(Schema& schema, const std::string& section, std::vector<Key> keys) {
  for (Key& key : keys) {
    key.section = section;
    schema.keys.push_back(std::move(key));
  }
}
inline void add_section(Schema& schema, const Section& section, std::vector<Key> keys) {
  schema.sections.push_back(section);
  add_keys(schema, section.name, std::move(keys));
}

void add_placement_keys(Schema& schema, const char* section);  // scale, rotate, translate
void add_body_sections(Schema& schema);                        // mesh, material and initial state of a body
void add_action_sections(Schema& schema);                      // pins, motions, loads and damping

void add_contact_sections(Schema& schema);

}  // namespace aspic
