// The part of the schema that says what a body is and where it starts.
#include "scene/schema_table.h"

namespace aspic {
namespace {

const Range kLength{.min = 0, .min_open = true};

void add_body(Schema& s) {
  s.sections.push_back({"body", "[[body]]",
                        "A soft body: a mesh at rest, placed by scale, then rotate, then translate; what it is made "
                        "of; how it starts; what holds and moves it."});
  add_keys(
      s, "body",
      {{.name = "name",
        .accepts = kText,
        .meaning = "letters, digits, _ and -; default: the file's name without extension, or body1, body2, ..."},
       {.name = "mesh",
        .accepts = kText,
        .required = true,
        .meaning = "file of tets, or of a closed surface, which is filled with tets"},
       {.name = "mesh_size",
        .accepts = kNumber,
        .unit = "the file's",
        .range = {.min = 0},
        .meaning = "edge length of the tets that fill a surface; default: diagonal of the bounding box / 25"},
       {.name = "shape", .accepts = kTable, .table = "shape", .meaning = "a mesh that is generated"},
       {.name = "mesh_hash",
        .accepts = kText,
        .meaning = "of vertices and tets before they are placed; written into resolved scenes and then checked"},
       {.name = "skin",
        .accepts = kText,
        .meaning = "surface file that the tets carry along, in the units of `mesh` and placed with it; default: the "
                   "surface that was filled, or the boundary of the tets"},
       {.name = "scale",
        .accepts = kNumber | kNumbers,
        .fallback = "1.0",
        .range = kLength,
        .meaning = "factor on the rest shape, about the origin",
        .reason = "the file is in metres"},
       {.name = "rotate", .accepts = kTable, .table = "rotate", .meaning = "turns the rest shape about the origin"},
       {.name = "translate",
        .accepts = kNumbers,
        .unit = "m",
        .fallback = "[0.0, 0.0, 0.0]",
        .meaning = "moves the rest shape",
        .reason = "stays where it is"},
       {.name = "elastic",
        .accepts = kBoolean,
        .fallback = "true",
        .meaning = "false: no elastic energy, only mass, as for a pure mass-spring body",
        .reason = "a body is a continuum"},
       {.name = "material", .accepts = kTable, .fallback = "{}", .table = "material", .meaning = "what it is made of"},
       {.name = "deform",
        .accepts = kTable,
        .table = "deform",
        .meaning = "initial shape relative to rest; default: at rest"},
       {.name = "velocity",
        .accepts = kExpressions,
        .unit = "m/s",
        .fallback = "[0.0, 0.0, 0.0]",
        .meaning = "initial velocity, of the rest position (X, Y, Z)",
        .reason = "at rest"},
       {.name = "angular_velocity",
        .accepts = kNumbers,
        .unit = "rad/s",
        .fallback = "[0.0, 0.0, 0.0]",
        .meaning = "adds omega x (x - centre of mass) to the velocity",
        .reason = "at rest"},
       {.name = "damping",
        .accepts = kTable,
        .fallback = "{}",
        .table = "damping",
        .meaning = "what dissipates besides the integrator"},
       {.name = "pin", .accepts = kTables, .table = "pin", .meaning = "vertices whose positions are prescribed"},
       {.name = "spring", .accepts = kTables, .table = "spring", .meaning = "springs"},
       {.name = "grab", .accepts = kTables, .table = "grab", .meaning = "points that a hand pulls along a path"},
       {.name = "traction",
        .accepts = kTables,
        .table = "traction",
        .meaning = "loads on the surface that keep their direction"},
       {.name = "pressure", .accepts = kTables, .table = "pressure", .meaning = "pressures that follow the surface"},
       {.name = "force", .accepts = kTables, .table = "force", .meaning = "dead loads per volume"}});
  s.alternatives.push_back({"body", {{"mesh", "mesh_size"}, {"shape"}}, true});
}

void add_shapes(Schema& s) {
  const auto length = [&](const char* section, const char* name, const char* meaning) {
    add_key(s, section,
            {.name = name, .accepts = kNumber, .unit = "m", .required = true, .range = kLength, .meaning = meaning});
  };
  const auto shape = [&](const char* name, const char* meaning) {
    add_key(s, "shape", {.name = name, .accepts = kTable, .table = name, .meaning = meaning});
  };
  s.sections.push_back({"shape", "shape = { ... } in a [[body]]", "One of the generated meshes."});
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
             .range = kLength,
             .meaning = "edge length of the cells, about"},
            {.name = "cut",
             .accepts = kText,
             .fallback = "\"kuhn\"",
             .choices = {"kuhn", "five"},
             .meaning = "six tets per cell along a diagonal, or five, alternating",
             .reason = "refines without surprises"}});
  s.alternatives.push_back({"box", {{"cells"}, {"size"}}, true});

  s.sections.push_back({"cylinder", "cylinder = { ... }", "A cylinder about the z axis."});
  length("cylinder", "radius", "radius");
  length("cylinder", "height", "length along z");
  length("cylinder", "size", "edge length, about");
  s.sections.push_back({"sphere", "sphere = { ... } as a shape", "A ball about the origin."});
  length("sphere", "radius", "radius");
  length("sphere", "size", "edge length, about");
  s.sections.push_back({"torus", "torus = { ... }", "A torus about the z axis."});
  length("torus", "major_radius", "from the centre to the middle of the tube");
  length("torus", "minor_radius", "of the tube");
  length("torus", "size", "edge length, about");
}

void add_placement(Schema& s) {
  s.sections.push_back({"rotate", "rotate = { ... } in a [[body]]", "A rotation about the origin."});
  add_keys(s, "rotate",
           {{.name = "axis", .accepts = kNumbers, .required = true, .meaning = "of any length but 0"},
            {.name = "angle_deg",
             .accepts = kNumber,
             .unit = "degrees",
             .required = true,
             .meaning = "counter-clockwise when the axis points at you"},
            {.name = "euler_deg",
             .accepts = kNumbers,
             .unit = "degrees",
             .meaning = "about x, then y, then z, axes fixed in space"}});
  s.alternatives.push_back({"rotate", {{"axis", "angle_deg"}, {"euler_deg"}}, true});

  s.sections.push_back({"deform", "deform = { ... } in a [[body]]",
                        "The shape at time 0 relative to the placed rest shape; about the centre of the bounding box "
                        "where a centre matters."});
  add_keys(
      s, "deform",
      {{.name = "scale", .accepts = kNumber | kNumbers, .range = {.min = 0}, .meaning = "stretch, about the centre"},
       {.name = "matrix", .accepts = kMatrix, .meaning = "deformation gradient, by rows, about the centre"},
       {.name = "twist", .accepts = kTable, .table = "twist", .meaning = "rotation that grows along an axis"},
       {.name = "displacement",
        .accepts = kExpressions,
        .unit = "m",
        .meaning = "added to the rest position (X, Y, Z)"},
       {.name = "file",
        .accepts = kText,
        .unit = "m",
        .required = true,
        .meaning = "CSV with the displacement x,y,z of each vertex"},
       {.name = "hash",
        .accepts = kText,
        .meaning = "of the file's contents; written into resolved scenes and then checked"}});
  s.alternatives.push_back({"deform", {{"scale"}, {"matrix"}, {"twist"}, {"displacement"}, {"file", "hash"}}, true});

  s.sections.push_back({"twist", "twist = { ... } in deform", "Each slice across the axis turns with its distance."});
  add_keys(s, "twist",
           {{.name = "axis", .accepts = kNumbers, .required = true, .meaning = "through the centre"},
            {.name = "angle_deg",
             .accepts = kNumber,
             .unit = "degrees",
             .required = true,
             .meaning = "between the two ends of the body"}});
}

}  // namespace

void add_body_sections(Schema& s) {
  add_body(s);
  add_shapes(s);
  add_placement(s);
}

}  // namespace aspic
