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

void add_placement_keys(Schema& schema, const char* section);  // scale, rotate, translate
void add_body_sections(Schema& schema);                        // mesh, material and initial state of a body
void add_action_sections(Schema& schema);                      // pins, motions, loads and damping

void add_contact_sections(Schema& schema);

}  // namespace aspic
