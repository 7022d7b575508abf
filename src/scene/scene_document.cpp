#include "scene/scene_document.h"

#include "scene/completion.h"
#include "scene/overrides.h"
#include "scene/schema.h"
#include "scene/toml_reader.h"

namespace aspic {

Table read_scene_document(const std::string& text, const std::string& source,
                          const std::vector<std::string>& overrides) {
  Table document = read_toml(text, source);
  for (const std::string& override_text : overrides) apply_override(document, override_text);
  check_and_complete(document, source);
  complete_scene(document);
  return document;
}

}  // namespace aspic
