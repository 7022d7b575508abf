// The common parts of the messages about live and recorded scenes.
#pragma once
#include "energy/probe.h"
#include "scene/value.h"
#include "viewer/arguments.h"
#include "viewer/fields.h"

namespace aspic::viewer {

Json json_of(const Vec3d& x);
Json tip_json(const Tip& tip);  // {"shape", "contact", "radius", "stiffness"}
Json fields_json(const std::vector<Field>& fields);
Vec3d up_of(const Table& document);  // opposite to gravity; the y axis without gravity

}  // namespace aspic::viewer
