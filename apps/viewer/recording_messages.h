// The description of a recorded run in the messages of web/src/protocol.ts.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "viewer/fields.h"
#include "viewer/recorded_body.h"
#include "viewer/run_tables.h"

namespace aspic::viewer {

struct RecordedScene {
  const Scene& scene;
  const RecordedBody& body;
  const std::vector<Field>& fields;
  const RunTables& tables;
  Vec3d lower, upper;  // bounding box of the start [m]
  std::string note;    // empty: none
};
Json hello_message(const RecordedScene& recorded);
Json scene_messages(const RecordedScene& recorded);  // one message per surface

}  // namespace aspic::viewer
