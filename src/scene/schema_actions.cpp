// Schema of pins, motions, loads and damping.
#include "scene/schema_table.h"

namespace aspic {
namespace {

void add_damping(Schema& s) {
  s.sections.push_back({"damping", "damping = { ... } in a [[body]]", "Dissipation besides that of the integrator."});
  add_keys(s, "damping",
           {{.name = "mass",
             .accepts = kNumber,
             .unit = "1/s",
             .fallback = "0.0",
             .range = kNotNegative,
             .meaning = "Rayleigh a of C = a M + b K",
             .reason = "none"},
            {.name = "stiffness",
             .accepts = kNumber,
             .unit = "s",
             .fallback = "0.0",
             .range = kNotNegative,
             .meaning = "Rayleigh b of C = a M + b K",
             .reason = "none"},
            {.name = "viscosity",
             .accepts = kNumber | kExpression | kTable,
             .unit = "Pa s",
             .fallback = "0.0",
             .range = kNotNegative,
             .table = "field",
             .meaning = "strain-rate damping, zero for rigid rotations",
             .reason = "none"}});
}

void add_where(Schema& s) {
  s.sections.push_back(
      {"where", "where = ... of a pin, spring, traction, pressure or force",
       "A selection by rest position: vertices, boundary triangles or tets (by centroid). A string is a formula of "
       "X, Y, Z (or x, y, z) that is nonzero where selected: \"y > 0.9 && x < 0\"."});
  add_keys(s, "where",
           {{.name = "box", .accepts = kTable, .table = "region_box", .meaning = "inside a box"},
            {.name = "sphere", .accepts = kTable, .table = "region_sphere", .meaning = "inside a sphere"},
            {.name = "vertices",
             .accepts = kIntegers,
             .range = kNotNegative,
             .meaning = "indices in the body, from 0; triangles and tets with all corners in the list"},
            {.name = "lowest",
             .accepts = kNumber,
             .range = {.min = 0, .max = 1},
             .meaning = "lowest fraction of the body's height, along gravity (or -y)"},
            {.name = "highest",
             .accepts = kNumber,
             .range = {.min = 0, .max = 1},
             .meaning = "highest fraction of the body's height"}});
  s.alternatives.push_back({"where", {{"box"}, {"sphere"}, {"vertices"}, {"lowest"}, {"highest"}}, true});

  s.sections.push_back({"region_box", "box = { ... } in where", "A closed box."});
  add_key(s, "region_box",
          {.name = "lower", .accepts = kNumbers, .unit = "m", .required = true, .meaning = "lowest corner"});
  add_key(s, "region_box",
          {.name = "upper", .accepts = kNumbers, .unit = "m", .required = true, .meaning = "highest corner"});
  s.sections.push_back({"region_sphere", "sphere = { ... } in where", "A closed ball."});
  add_key(s, "region_sphere",
          {.name = "center", .accepts = kNumbers, .unit = "m", .required = true, .meaning = "center"});
  add_key(
      s, "region_sphere",
      {.name = "radius", .accepts = kNumber, .unit = "m", .required = true, .range = kPositive, .meaning = "radius"});
}

void add_motion(Schema& s) {
  s.sections.push_back({"motion", "motion = \"fixed\" or { ... }",
                        "Motion of pinned vertices, spring targets or obstacles from their positions at time 0."});
  add_keys(s, "motion",
           {{.name = "linear", .accepts = kTable, .table = "linear", .meaning = "constant velocity"},
            {.name = "rotate", .accepts = kTable, .table = "spin", .meaning = "constant rotation"},
            {.name = "keyframes",
             .accepts = kTables,
             .table = "keyframe",
             .meaning = "piecewise linear displacements, constant before and after"},
            {.name = "displacement",
             .accepts = kMovingExpressions,
             .unit = "m",
             .meaning = "function of the position (X, Y, Z) at time 0 and of the time t"}});
  s.alternatives.push_back({"motion", {{"linear"}, {"rotate"}, {"keyframes"}, {"displacement"}}, true});

  const Key until{.name = "until",
                  .accepts = kNumber,
                  .unit = "s",
                  .range = kNotNegative,
                  .meaning = "end of the motion; default: never"};
  s.sections.push_back({"linear", "linear = { ... } in motion", "A translation."});
  add_key(s, "linear",
          {.name = "velocity", .accepts = kNumbers, .unit = "m/s", .required = true, .meaning = "velocity"});
  add_key(s, "linear", until);
  s.sections.push_back({"spin", "rotate = { ... } in motion", "A rotation."});
  add_keys(
      s, "spin",
      {{.name = "axis", .accepts = kNumbers, .required = true, .meaning = "any nonzero vector"},
       {.name = "center",
        .accepts = kNumbers,
        .unit = "m",
        .meaning = "point on the axis; default: mean of the vertices"},
       {.name = "rate_deg", .accepts = kNumber, .unit = "degrees/s", .required = true, .meaning = "right-handed"}});
  add_key(s, "spin", until);
  s.sections.push_back({"keyframe", "keyframes = [{ ... }, ...] in motion", "A displacement at a time."});
  add_key(s, "keyframe",
          {.name = "time",
           .accepts = kNumber,
           .unit = "s",
           .required = true,
           .range = kNotNegative,
           .meaning = "ascending"});
  add_key(
      s, "keyframe",
      {.name = "displacement", .accepts = kNumbers, .unit = "m", .required = true, .meaning = "relative to time 0"});
}

Key where_key() {
  return {.name = "where", .accepts = kExpression | kTable, .required = true, .table = "where", .meaning = "selection"};
}

void add_pin_and_spring(Schema& s) {
  s.sections.push_back({"pin", "[[body.pin]]",
                        "Prescribed positions (Dirichlet conditions): in all directions, along some axes (a roller: "
                        "`axes = \"y\"`), or along one direction (a symmetry plane: its normal). Several pins may hold "
                        "a vertex in independent directions. Pinned vertices have the velocity of their pin."});
  add_key(s, "pin", {.name = "name", .accepts = kText, .meaning = "default: pin1, pin2, ..."});
  add_key(s, "pin", where_key());
  add_key(s, "pin",
          {.name = "motion",
           .accepts = kText | kTable,
           .fallback = "\"fixed\"",
           .choices = {"fixed"},
           .table = "motion",
           .meaning = "prescribed motion",
           .reason = "fixes the body"});
  add_keys(s, "pin",
           {{.name = "axes",
             .accepts = kText,
             .fallback = "\"xyz\"",
             .choices = {"x", "y", "z", "xy", "xz", "yz", "xyz"},
             .meaning = "fixed axes; the others are free",
             .reason = "fixes the body"},
            {.name = "direction", .accepts = kNumbers, .meaning = "single fixed direction, any nonzero vector"}});
  s.alternatives.push_back({"pin", {{"axes"}, {"direction"}}});

  s.sections.push_back({"spring", "[[body.spring]]",
                        "Springs to points (`where`), between vertices (`between`), or along all edges (`edges`)."});
  add_keys(s, "spring",
           {{.name = "stiffness",
             .accepts = kNumber,
             .unit = "N/m",
             .required = true,
             .range = kPositive,
             .meaning = "k of V = k/2 (length - rest length)^2"},
            where_key(),
            {.name = "target",
             .accepts = kNumbers,
             .unit = "m",
             .meaning = "common target; default: each vertex's position at time 0"},
            {.name = "motion",
             .accepts = kText | kTable,
             .fallback = "\"fixed\"",
             .choices = {"fixed"},
             .table = "motion",
             .meaning = "motion of the targets",
             .reason = "fixed targets"},
            {.name = "between",
             .accepts = kPairs,
             .required = true,
             .range = kNotNegative,
             .meaning = "pairs of vertex indices, from 0"},
            {.name = "to_body", .accepts = kText, .meaning = "body of the second index; default: this one"},
            {.name = "rest_length",
             .accepts = kNumber,
             .unit = "m",
             .range = kNotNegative,
             .meaning = "default: distance at rest"},
            {.name = "edges",
             .accepts = kBoolean,
             .required = true,
             .meaning = "true: a spring along each edge of the tets"}});
  s.alternatives.push_back(
      {"spring", {{"where", "target", "motion"}, {"between", "to_body", "rest_length"}, {"edges"}}, true});
}

void add_grab(Schema& s) {
  s.sections.push_back({"grab", "[[body.grab]]",
                        "A spring from a point of a tet to a hand that moves along a path, active during the path. The "
                        "viewer saves drags in this form."});
  add_keys(s, "grab",
           {{.name = "stiffness",
             .accepts = kNumber,
             .unit = "N/m",
             .required = true,
             .range = kPositive,
             .meaning = "k of V = k/2 |p - hand|^2"},
            {.name = "point",
             .accepts = kTables,
             .required = true,
             .table = "grab_vertex",
             .meaning = "p: weighted sum of the vertices of one tet"},
            {.name = "path",
             .accepts = kTables,
             .required = true,
             .table = "grab_place",
             .meaning = "piecewise linear path of the hand; at least two places"}});
  s.sections.push_back({"grab_vertex", "point = [{ ... }, ...] in a grab", "A vertex and its weight."});
  add_keys(s, "grab_vertex",
           {{.name = "vertex",
             .accepts = kInteger,
             .required = true,
             .range = kNotNegative,
             .meaning = "index in the body, from 0"},
            {.name = "weight", .accepts = kNumber, .required = true, .meaning = "the four weights sum to 1"}});
  s.sections.push_back({"grab_place", "path = [{ ... }, ...] in a grab", "A position of the hand."});
  add_keys(s, "grab_place",
           {{.name = "time",
             .accepts = kNumber,
             .unit = "s",
             .required = true,
             .range = kNotNegative,
             .meaning = "ascending"},
            {.name = "position", .accepts = kNumbers, .unit = "m", .required = true, .meaning = "position"}});
}

void add_loads(Schema& s) {
  s.sections.push_back({"traction", "[[body.traction]]", "A dead load: force per rest area, of fixed direction."});
  add_key(s, "traction", where_key());
  add_key(s, "traction",
          {.name = "value",
           .accepts = kMovingExpressions,
           .unit = "Pa",
           .meaning = "function of the centroid (X, Y, Z) and the time t"});
  add_key(s, "traction",
          {.name = "dead_pressure",
           .accepts = kNumber | kMovingExpression,
           .unit = "Pa",
           .meaning = "along the inward normal at rest; function of the centroid and the time t"});
  s.alternatives.push_back({"traction", {{"value"}, {"dead_pressure"}}, true});

  s.sections.push_back(
      {"pressure", "[[body.pressure]]", "A follower pressure: normal to the deformed surface, per deformed area."});
  add_key(s, "pressure", where_key());
  add_key(s, "pressure",
          {.name = "value",
           .accepts = kNumber | kMovingExpression,
           .unit = "Pa",
           .required = true,
           .meaning = "uniform, positive inwards; function of the time t"});

  s.sections.push_back({"force", "[[body.force]]", "A dead load: force per rest volume."});
  Key everywhere = where_key();
  everywhere.required = false;
  everywhere.fallback = "\"all\"";
  everywhere.reason = "the whole body";
  add_key(s, "force", everywhere);
  add_key(s, "force",
          {.name = "value",
           .accepts = kMovingExpressions,
           .unit = "N/m^3",
           .required = true,
           .meaning = "function of the centroid (X, Y, Z) and the time t"});
}

}  // namespace

void add_action_sections(Schema& s) {
  add_damping(s);
  add_where(s);
  add_motion(s);
  add_pin_and_spring(s);
  add_grab(s);
  add_loads(s);
}

}  // namespace aspic
