// What the messages about a live and a recorded scene have in common.
#pragma once
#include "energy/probe.h"
#include "scene/value.h"
#include "viewer/arguments.h"
#include "viewer/fields.h"

namespace aspic::viewer {

Json json_of(const Vec3d& x);
Json tip_json(const Tip& tip);  // {"shape", "contact", "radius", "stiffness"}
Json fields_json(const std::vector<Field>& fields);
Vec3d up_of(const Table& document);  // against gravity; along y where there is none

}  // namespace aspic::viewer
