// Schema of contact and obstacles.
#include "scene/schema_table.h"

namespace aspic {

void add_contact_sections(Schema& s) {
  add_keys(s, "scene",
           {{.name = "contact",
             .accepts = kTable,
             .table = "contact",
             .meaning = "switches contact on: bodies touch each other, themselves and obstacles"},
            {.name = "obstacle",
             .accepts = kTables,
             .table = "obstacle",
             .meaning = "surfaces with prescribed motion; they switch contact on"}});
  s.sections.push_back({"contact", "[contact]", "Contact with friction. The defaults suit most scenes."});
  add_keys(
      s, "contact",
      {{.name = "friction",
        .accepts = kNumber,
        .fallback = "0.0",
        .range = kNotNegative,
        .meaning = "coefficient of friction of bodies and obstacles without their own; that of a pair is the "
                   "geometric mean, unless `pair` gives another",
        .reason = "none; rubber on a smooth floor has 0.3 to 0.8"},
       {.name = "reach",
        .accepts = kNumber,
        .unit = "m",
        .range = kPositive,
        .meaning = "distance at which contact forces begin; default: a fiftieth of the mean edge of the finer "
                   "surface"},
       {.name = "stiffness",
        .accepts = kNumber,
        .unit = "Pa",
        .range = kPositive,
        .meaning = "pressure scale of contact forces; default: a tenth of the smaller Young's modulus"},
       {.name = "creep",
        .accepts = kNumber,
        .unit = "m/s",
        .range = kPositive,
        .meaning = "largest speed of surfaces that stick; default: 1e-4 sqrt(9.81 m/s^2 L) for bodies of size L"},
       {.name = "start",
        .accepts = kText,
        .fallback = "\"apart\"",
        .choices = {"apart", "inflate"},
        .meaning = "`apart`: overlap is an error; `inflate`: bodies without pins shrink, then grow back in contact",
        .reason = "overlap is most often a mistake"},
       {.name = "pair", .accepts = kTables, .table = "pair", .meaning = "friction of single pairs"}});
  s.sections.push_back({"pair", "[[contact.pair]]", "Friction between two bodies or obstacles, or within a body."});
  add_keys(
      s, "pair",
      {{.name = "between", .accepts = kNames, .required = true, .meaning = "two names; equal: self-contact"},
       {.name = "friction", .accepts = kNumber, .required = true, .range = kNotNegative, .meaning = "coefficient"}});

  s.sections.push_back({"obstacle", "[[obstacle]]",
                        "A surface with prescribed motion, or at rest. Meshes and shapes are "
                        "placed by scale, rotate, translate in this order."});
  add_keys(s, "obstacle",
           {{.name = "name", .accepts = kText, .meaning = "default: obstacle1, obstacle2, ..."},
            {.name = "plane", .accepts = kTable, .table = "plane", .meaning = "an infinite plane"},
            {.name = "sphere", .accepts = kTable, .table = "obstacle_sphere", .meaning = "an exact sphere"},
            {.name = "capsule", .accepts = kTable, .table = "capsule", .meaning = "a segment with a radius"},
            {.name = "mesh", .accepts = kText, .required = true, .meaning = "triangle mesh, open or closed"},
            {.name = "hash", .accepts = kText, .meaning = "hash of the file, in resolved scenes"},
            {.name = "shape", .accepts = kTable, .table = "shape", .meaning = "the boundary of a generated shape"},
            {.name = "motion",
             .accepts = kText | kTable,
             .fallback = "\"fixed\"",
             .choices = {"fixed"},
             .table = "motion",
             .meaning = "prescribed motion; only meshes and shapes rotate",
             .reason = "most obstacles are at rest"},
            {.name = "recording",
             .accepts = kTable,
             .table = "recording",
             .meaning = "recorded positions of the vertices of `mesh`, instead of `motion`"},
            {.name = "friction", .accepts = kNumber, .range = kNotNegative, .meaning = "default: contact.friction"}});
  add_placement_keys(s, "obstacle");
  s.alternatives.push_back({"obstacle", {{"plane"}, {"sphere"}, {"capsule"}, {"mesh", "hash"}, {"shape"}}, true});
  const auto add_point = [&s](const char* table, const char* name, const char* meaning) {
    add_key(s, table, {.name = name, .accepts = kNumbers, .unit = "m", .required = true, .meaning = meaning});
  };
  const auto add_radius = [&s](const char* table) {
    add_key(
        s, table,
        {.name = "radius", .accepts = kNumber, .unit = "m", .required = true, .range = kPositive, .meaning = "radius"});
  };
  s.sections.push_back({"recording", "recording = { ... } in an [[obstacle]]",
                        "A PC2 point cache, as Blender writes it; placed like the mesh."});
  add_keys(s, "recording",
           {{.name = "file", .accepts = kText, .required = true, .meaning = "point cache"},
            {.name = "hash", .accepts = kText, .meaning = "hash of the file, in resolved scenes"},
            {.name = "fps",
             .accepts = kNumber,
             .unit = "1/s",
             .fallback = "24.0",
             .range = kPositive,
             .meaning = "frames per second",
             .reason = "the default of Blender"}});
  s.sections.push_back({"obstacle_sphere", "sphere = { ... } in an [[obstacle]]", "A sphere without facets."});
  add_point("obstacle_sphere", "center", "center");
  add_radius("obstacle_sphere");
  s.sections.push_back({"capsule", "capsule = { ... } in an [[obstacle]]", "The points within a radius of a segment."});
  add_point("capsule", "from", "one end of the segment");
  add_point("capsule", "to", "the other end");
  add_radius("capsule");
  s.sections.push_back({"plane", "plane = { ... } in an [[obstacle]]", "A half-space that bodies stay out of."});
  add_keys(s, "plane",
           {{.name = "origin",
             .accepts = kNumbers,
             .unit = "m",
             .fallback = "[0.0, 0.0, 0.0]",
             .meaning = "a point of the plane",
             .reason = "a floor at height 0"},
            {.name = "normal",
             .accepts = kNumbers,
             .fallback = "[0.0, 1.0, 0.0]",
             .meaning = "direction of the free side, any length but 0",
             .reason = "a floor under gravity along -y"}});
}

}  // namespace aspic
