// The three parts of the table behind scene_schema().
#pragma once
#include <utility>

#include "scene/schema.h"

namespace aspic {

inline const Range kPositive{.min = 0, .min_open = true};
inline const Range kNotNegative{.min = 0};

inline void add_key(Schema& schema, const char* section, Key key) {
  key.section = section;
  schema.keys.push_back(std::move(key));
}
inline void add_keys(Schema& schema, const char* section, std::vector<Key> keys) {
  for (Key& key : keys) add_key(schema, section, std::move(key));
}

void add_body_sections(Schema& schema);    // what a body is and where it starts
void add_action_sections(Schema& schema);  // what holds, moves, loads and slows it

}  // namespace aspic
