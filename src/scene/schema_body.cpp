// Schema of bodies: mesh, placement, material and initial state.
#include "scene/schema_table.h"

namespace aspic {
namespace {

void add_body(Schema& s) {
  s.sections.push_back({"body", "[[body]]",
                        "A soft body: its rest mesh, placed by scale, rotate, translate in this order; material; "
                        "initial state; pins and loads."});
  add_keys(s, "body",
           {{.name = "name",
             .accepts = kText,
             .meaning = "letters, digits, _ and -; default: the file's name, or body1, body2, ..."},
            {.name = "mesh",
             .accepts = kText,
             .required = true,
             .meaning = "file of tets, or of a closed surface to be filled"},
            {.name = "mesh_size",
             .accepts = kNumber,
             .unit = "the file's",
             .range = {.min = 0},
             .meaning = "edge length for filling; default: diagonal of the bounding box / 25"},
            {.name = "shape", .accepts = kTable, .table = "shape", .meaning = "generated mesh"},
            {.name = "mesh_hash", .accepts = kText, .meaning = "hash of the mesh, in resolved scenes"},
            {.name = "skin",
             .accepts = kText,
             .meaning = "surface file embedded in the tets, placed like `mesh`; default: the filled surface, or the "
                        "boundary of the tets"}});
  add_placement_keys(s, "body");
  add_keys(s, "body",
           {{.name = "friction",
             .accepts = kNumber,
             .range = kNotNegative,
             .meaning = "coefficient of friction in contact; default: contact.friction"},
            {.name = "elastic",
             .accepts = kBoolean,
             .fallback = "true",
             .meaning = "false: no elastic energy, as for a mass-spring body",
             .reason = "a body is a continuum"},
            {.name = "material", .accepts = kTable, .fallback = "{}", .table = "material", .meaning = "material"},
            {.name = "deform", .accepts = kTable, .table = "deform", .meaning = "initial shape; default: at rest"},
            {.name = "velocity",
             .accepts = kExpressions,
             .unit = "m/s",
             .fallback = "[0.0, 0.0, 0.0]",
             .meaning = "initial velocity of free vertices, a function of the rest position",
             .reason = "at rest"},
            {.name = "angular_velocity",
             .accepts = kNumbers,
             .unit = "rad/s",
             .fallback = "[0.0, 0.0, 0.0]",
             .meaning = "adds omega x (x - center of mass) to the velocity",
             .reason = "at rest"},
            {.name = "damping", .accepts = kTable, .fallback = "{}", .table = "damping", .meaning = "damping"},
            {.name = "pin", .accepts = kTables, .table = "pin", .meaning = "prescribed positions"},
            {.name = "spring", .accepts = kTables, .table = "spring", .meaning = "springs"},
            {.name = "grab", .accepts = kTables, .table = "grab", .meaning = "points dragged along a path"},
            {.name = "traction", .accepts = kTables, .table = "traction", .meaning = "dead loads on the surface"},
            {.name = "pressure", .accepts = kTables, .table = "pressure", .meaning = "follower pressures"},
            {.name = "force", .accepts = kTables, .table = "force", .meaning = "dead loads per volume"}});
  s.alternatives.push_back({"body", {{"mesh", "mesh_size"}, {"shape"}}, true});
}

void add_shapes(Schema& s) {
  const auto length = [&](const char* section, const char* name, const char* meaning) {
    add_key(s, section,
            {.name = name, .accepts = kNumber, .unit = "m", .required = true, .range = kPositive, .meaning = meaning});
  };
  const auto shape = [&](const char* name, const char* meaning) {
    add_key(s, "shape", {.name = name, .accepts = kTable, .table = name, .meaning = meaning});
  };
  s.sections.push_back({"shape", "shape = { ... } in a [[body]]", "A generated mesh."});
  shape("box", "a box along the axes");
  shape("cylinder", "from z = 0 to z = height");
  shape("sphere", "about the origin");
  shape("torus", "about the z axis");
  s.alternatives.push_back({"shape", {{"box"}, {"cylinder"}, {"sphere"}, {"torus"}}, true});

  s.sections.push_back({"box", "box = { ... }", "A box cut into cells, each into tets."});
  add_keys(s, "box",
           {{.name = "lower",
             .accepts = kNumbers,
             .unit = "m",
             .fallback = "[0.0, 0.0, 0.0]",
             .meaning = "lowest corner",
             .reason = "the origin"},
            {.name = "upper", .accepts = kNumbers, .unit = "m", .required = true, .meaning = "highest corner"},
            {.name = "cells",
             .accepts = kIntegers,
             .required = true,
             .range = {.min = 1, .max = 10000},
             .meaning = "cells along x, y and z"},
            {.name = "size",
             .accepts = kNumber,
             .unit = "m",
             .required = true,
             .range = kPositive,
             .meaning = "approximate edge length"},
            {.name = "cut",
             .accepts = kText,
             .fallback = "\"kuhn\"",
             .choices = {"kuhn", "five"},
             .meaning = "six tets per cell, or five, alternating",
             .reason = "refines uniformly"}});
  s.alternatives.push_back({"box", {{"cells"}, {"size"}}, true});

  s.sections.push_back({"cylinder", "cylinder = { ... }", "A cylinder about the z axis."});
  length("cylinder", "radius", "radius");
  length("cylinder", "height", "length along z");
  length("cylinder", "size", "approximate edge length");
  s.sections.push_back({"sphere", "sphere = { ... } as a shape", "A ball about the origin."});
  length("sphere", "radius", "radius");
  length("sphere", "size", "approximate edge length");
  s.sections.push_back({"torus", "torus = { ... }", "A torus about the z axis."});
  length("torus", "major_radius", "radius of the center line");
  length("torus", "minor_radius", "radius of the tube");
  length("torus", "size", "approximate edge length");
}

void add_placement(Schema& s) {
  s.sections.push_back({"rotate", "rotate = { ... } in a [[body]]", "A rotation about the origin."});
  add_keys(s, "rotate",
           {{.name = "axis", .accepts = kNumbers, .required = true, .meaning = "any nonzero vector"},
            {.name = "angle_deg", .accepts = kNumber, .unit = "degrees", .required = true, .meaning = "right-handed"},
            {.name = "euler_deg",
             .accepts = kNumbers,
             .unit = "degrees",
             .meaning = "about x, then y, then z, fixed axes"}});
  s.alternatives.push_back({"rotate", {{"axis", "angle_deg"}, {"euler_deg"}}, true});

  s.sections.push_back(
      {"deform", "deform = { ... } in a [[body]]",
       "The shape at time 0 relative to the placed rest shape, about the center of its bounding box."});
  add_keys(s, "deform",
           {{.name = "scale", .accepts = kNumber | kNumbers, .range = {.min = 0}, .meaning = "stretch"},
            {.name = "matrix", .accepts = kMatrix, .meaning = "deformation gradient by rows"},
            {.name = "twist", .accepts = kTable, .table = "twist", .meaning = "twist about an axis"},
            {.name = "displacement",
             .accepts = kExpressions,
             .unit = "m",
             .meaning = "function of the rest position (X, Y, Z)"},
            {.name = "file",
             .accepts = kText,
             .unit = "m",
             .required = true,
             .meaning = "CSV with a displacement x,y,z per vertex"},
            {.name = "hash", .accepts = kText, .meaning = "hash of the file, in resolved scenes"}});
  s.alternatives.push_back({"deform", {{"scale"}, {"matrix"}, {"twist"}, {"displacement"}, {"file", "hash"}}, true});

  s.sections.push_back(
      {"twist", "twist = { ... } in deform", "A rotation proportional to the distance along the axis."});
  add_keys(s, "twist",
           {{.name = "axis", .accepts = kNumbers, .required = true, .meaning = "through the center"},
            {.name = "angle_deg",
             .accepts = kNumber,
             .unit = "degrees",
             .required = true,
             .meaning = "between the ends of the body"}});
}

}  // namespace

void add_placement_keys(Schema& s, const char* section) {
  add_keys(s, section,
           {{.name = "scale",
             .accepts = kNumber | kNumbers,
             .fallback = "1.0",
             .range = kPositive,
             .meaning = "scale factor about the origin",
             .reason = "the file is in meters"},
            {.name = "rotate", .accepts = kTable, .table = "rotate", .meaning = "rotation about the origin"},
            {.name = "translate",
             .accepts = kNumbers,
             .unit = "m",
             .fallback = "[0.0, 0.0, 0.0]",
             .meaning = "translation",
             .reason = "stays where it is"}});
}

void add_body_sections(Schema& s) {
  add_body(s);
  add_shapes(s);
  add_placement(s);
}

}  // namespace aspic
