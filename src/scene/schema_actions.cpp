// The part of the schema that says what holds, moves, loads and slows a body.
#include "scene/schema_table.h"

namespace aspic {
namespace {

void add_damping(Schema& s) {
  s.sections.push_back({"damping", "damping = { ... } in a [[body]]", "What dissipates besides the integrator."});
  add_keys(s, "damping",
           {{.name = "mass",
             .accepts = kNumber,
             .unit = "1/s",
             .fallback = "0.0",
             .range = kNotNegative,
             .meaning = "Rayleigh a of C = a M + b K: slows all motion",
             .reason = "none"},
            {.name = "stiffness",
             .accepts = kNumber,
             .unit = "s",
             .fallback = "0.0",
             .range = kNotNegative,
             .meaning = "Rayleigh b of C = a M + b K: slows fast vibrations",
             .reason = "none"},
            {.name = "viscosity",
             .accepts = kNumber | kExpression | kTable,
             .unit = "Pa s",
             .fallback = "0.0",
             .range = kNotNegative,
             .table = "field",
             .meaning = "strain-rate damping, which no rigid rotation feels; a value per tet like those of a material",
             .reason = "none"}});
}

void add_where(Schema& s) {
  s.sections.push_back(
      {"where", "where = ... of a pin, spring, traction, pressure or force",
       "A selection by rest position: of vertices; of boundary triangles (by centroid) for a "
       "traction or pressure; of tets (by centroid) for a force. One that selects nothing is an error. A string "
       "is a formula of X, Y, Z (or x, y, z) that is not 0 for what is meant: \"y > 0.9 && x < 0\"."});
  add_keys(s, "where",
           {{.name = "box", .accepts = kTable, .table = "region_box", .meaning = "inside a box"},
            {.name = "sphere", .accepts = kTable, .table = "region_sphere", .meaning = "inside a sphere"},
            {.name = "vertices",
             .accepts = kIntegers,
             .range = kNotNegative,
             .meaning = "indices in the body, from 0; triangles and tets with all corners among them"},
            {.name = "lowest",
             .accepts = kNumber,
             .range = {.min = 0, .max = 1},
             .meaning = "the lowest fraction of the body's height, along gravity (along -y without gravity)"},
            {.name = "highest",
             .accepts = kNumber,
             .range = {.min = 0, .max = 1},
             .meaning = "the highest fraction of the body's height"}});
  s.alternatives.push_back({"where", {{"box"}, {"sphere"}, {"vertices"}, {"lowest"}, {"highest"}}, true});

  s.sections.push_back({"region_box", "box = { ... } in where", "A closed box."});
  add_key(s, "region_box",
          {.name = "lower", .accepts = kNumbers, .unit = "m", .required = true, .meaning = "lowest corner"});
  add_key(s, "region_box",
          {.name = "upper", .accepts = kNumbers, .unit = "m", .required = true, .meaning = "highest corner"});
  s.sections.push_back({"region_sphere", "sphere = { ... } in where", "A closed ball."});
  add_key(s, "region_sphere",
          {.name = "center", .accepts = kNumbers, .unit = "m", .required = true, .meaning = "centre"});
  add_key(
      s, "region_sphere",
      {.name = "radius", .accepts = kNumber, .unit = "m", .required = true, .range = kPositive, .meaning = "radius"});
}

void add_motion(Schema& s) {
  s.sections.push_back({"motion", "motion = \"fixed\" or { ... }",
                        "How pinned vertices, or the targets of springs, move from where they are at time 0."});
  add_keys(s, "motion",
           {{.name = "linear", .accepts = kTable, .table = "linear", .meaning = "constant velocity"},
            {.name = "rotate", .accepts = kTable, .table = "spin", .meaning = "constant rotation"},
            {.name = "keyframes",
             .accepts = kTables,
             .table = "keyframe",
             .meaning = "displacements at given times, linear in between, constant before and after"},
            {.name = "displacement",
             .accepts = kMovingExpressions,
             .unit = "m",
             .meaning = "formulas of the position (X, Y, Z) at time 0 and of the time t"}});
  s.alternatives.push_back({"motion", {{"linear"}, {"rotate"}, {"keyframes"}, {"displacement"}}, true});

  const Key until{.name = "until",
                  .accepts = kNumber,
                  .unit = "s",
                  .range = kNotNegative,
                  .meaning = "then it stays; default: never"};
  s.sections.push_back({"linear", "linear = { ... } in motion", "A translation."});
  add_key(s, "linear",
          {.name = "velocity", .accepts = kNumbers, .unit = "m/s", .required = true, .meaning = "velocity"});
  add_key(s, "linear", until);
  s.sections.push_back({"spin", "rotate = { ... } in motion", "A rotation about a fixed axis."});
  add_keys(s, "spin",
           {{.name = "axis", .accepts = kNumbers, .required = true, .meaning = "of any length but 0"},
            {.name = "center",
             .accepts = kNumbers,
             .unit = "m",
             .meaning = "a point on the axis; default: the mean of the vertices"},
            {.name = "rate_deg",
             .accepts = kNumber,
             .unit = "degrees/s",
             .required = true,
             .meaning = "counter-clockwise when the axis points at you"}});
  add_key(s, "spin", until);
  s.sections.push_back({"keyframe", "keyframes = [{ ... }, ...] in motion", "A displacement at a time."});
  add_key(s, "keyframe",
          {.name = "time",
           .accepts = kNumber,
           .unit = "s",
           .required = true,
           .range = kNotNegative,
           .meaning = "later than the one before"});
  add_key(s, "keyframe",
          {.name = "displacement",
           .accepts = kNumbers,
           .unit = "m",
           .required = true,
           .meaning = "from the position at time 0"});
}

Key where_key() {
  return {.name = "where",
          .accepts = kExpression | kTable,
          .required = true,
          .table = "where",
          .meaning = "what is selected"};
}

void add_pin_and_spring(Schema& s) {
  s.sections.push_back(
      {"pin", "[[body.pin]]",
       "Vertices whose positions are prescribed exactly: in all directions, along some axes (a "
       "roller: `axes = \"y\"`) or along one direction (a symmetry plane: its normal). A vertex may be "
       "in several pins that hold it in independent directions, as where symmetry planes meet."});
  add_key(s, "pin", {.name = "name", .accepts = kText, .meaning = "default: pin1, pin2, ..."});
  add_key(s, "pin", where_key());
  add_key(s, "pin",
          {.name = "motion",
           .accepts = kText | kTable,
           .fallback = "\"fixed\"",
           .choices = {"fixed"},
           .table = "motion",
           .meaning = "how they move",
           .reason = "holds the body"});
  add_keys(
      s, "pin",
      {{.name = "axes",
        .accepts = kText,
        .fallback = "\"xyz\"",
        .choices = {"x", "y", "z", "xy", "xz", "yz", "xyz"},
        .meaning = "along which they are held; along the others they slide freely",
        .reason = "holds the body"},
       {.name = "direction",
        .accepts = kNumbers,
        .meaning = "the only one along which they are held, of any length but 0: the normal of a symmetry plane"}});
  s.alternatives.push_back({"pin", {{"axes"}, {"direction"}}});

  s.sections.push_back({"spring", "[[body.spring]]",
                        "Springs to points (`where`), between vertices (`between`), or along all edges (`edges`)."});
  add_keys(
      s, "spring",
      {{.name = "stiffness",
        .accepts = kNumber,
        .unit = "N/m",
        .required = true,
        .range = kPositive,
        .meaning = "k of V = k/2 (length - rest length)^2, of each spring"},
       where_key(),
       {.name = "target",
        .accepts = kNumbers,
        .unit = "m",
        .meaning = "a point for all; default: where each vertex is at time 0"},
       {.name = "motion",
        .accepts = kText | kTable,
        .fallback = "\"fixed\"",
        .choices = {"fixed"},
        .table = "motion",
        .meaning = "how the targets move",
        .reason = "they stay"},
       {.name = "between",
        .accepts = kPairs,
        .required = true,
        .range = kNotNegative,
        .meaning = "pairs of vertex indices, from 0"},
       {.name = "to_body", .accepts = kText, .meaning = "the body of the second index of each pair; default: this one"},
       {.name = "rest_length",
        .accepts = kNumber,
        .unit = "m",
        .range = kNotNegative,
        .meaning = "default: the distance at rest"},
       {.name = "edges",
        .accepts = kBoolean,
        .required = true,
        .meaning = "true: one spring along each edge of the tets"}});
  s.alternatives.push_back(
      {"spring", {{"where", "target", "motion"}, {"between", "to_body", "rest_length"}, {"edges"}}, true});
}

void add_grab(Schema& s) {
  s.sections.push_back({"grab", "[[body.grab]]",
                        "A spring between a point of a tet and a hand that moves along a path. It acts from the first "
                        "time of the path to the last one. The viewer saves what its mouse did in this form."});
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
             .meaning = "p: the weighted sum of the four vertices of one tet"},
            {.name = "path",
             .accepts = kTables,
             .required = true,
             .table = "grab_place",
             .meaning = "where the hand is, linear in between; at least two places"}});
  s.sections.push_back({"grab_vertex", "point = [{ ... }, ...] in a grab", "A vertex and its share of the point."});
  add_keys(s, "grab_vertex",
           {{.name = "vertex",
             .accepts = kInteger,
             .required = true,
             .range = kNotNegative,
             .meaning = "index in the body, from 0"},
            {.name = "weight", .accepts = kNumber, .required = true, .meaning = "the four weights sum to 1"}});
  s.sections.push_back({"grab_place", "path = [{ ... }, ...] in a grab", "A place of the hand at a time."});
  add_keys(s, "grab_place",
           {{.name = "time",
             .accepts = kNumber,
             .unit = "s",
             .required = true,
             .range = kNotNegative,
             .meaning = "later than the one before"},
            {.name = "position", .accepts = kNumbers, .unit = "m", .required = true, .meaning = "of the hand"}});
}

void add_loads(Schema& s) {
  s.sections.push_back({"traction", "[[body.traction]]",
                        "A force per area of the rest shape; it keeps its direction when the body turns."});
  add_key(s, "traction", where_key());
  add_key(s, "traction",
          {.name = "value",
           .accepts = kMovingExpressions,
           .unit = "Pa",
           .meaning = "of the centroid (X, Y, Z) of each triangle and of the time t"});
  add_key(s, "traction",
          {.name = "dead_pressure",
           .accepts = kNumber | kMovingExpression,
           .unit = "Pa",
           .meaning = "against the outward normal at rest; of the centroid (X, Y, Z) and of the time t"});
  s.alternatives.push_back({"traction", {{"value"}, {"dead_pressure"}}, true});

  s.sections.push_back({"pressure", "[[body.pressure]]",
                        "A pressure that follows the surface: it stays normal to it and acts on its deformed area."});
  add_key(s, "pressure", where_key());
  add_key(s, "pressure",
          {.name = "value",
           .accepts = kNumber | kMovingExpression,
           .unit = "Pa",
           .required = true,
           .meaning = "against the outward normal: positive presses; the same all over the surface, of the time t"});

  s.sections.push_back({"force", "[[body.force]]", "A force per volume of the rest shape."});
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
           .meaning = "of the centroid (X, Y, Z) of each tet and of the time t"});
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
