// Schema of bodies: mesh, placement, material and initial state.
#include "scene/schema_table.h"

namespace aspic {
namespace {

void add_body(Schema& s) {
  add_section(
      s,
      {"body", "[[body]]",
       "A soft body: its rest mesh, placed by scale, rotate, translate in this order; material; "
       "initial state; pins and loads."},
      {key("name", kText, "letters, digits, _ and -; default: the file's name, or body1, body2, ..."),
       key("mesh", kText, "file of tets, or of a closed surface to be filled", kRequired),
       key("mesh_size", kNumber, "edge length for filling; default: diagonal of the bounding box / 25",
           Units{"the file's"}, Range{.min = 0}),
       key("shape", kTable, "generated mesh", Members{"shape"}),
       key("mesh_hash", kText, "hash of the mesh, in resolved scenes"),
       key("skin", kText,
           "surface file embedded in the tets, placed like `mesh`; default: the filled surface, or the boundary "
           "of the tets")});
  add_placement_keys(s, "body");
  add_keys(s, "body",
           {key("friction", kNumber, "coefficient of friction in contact; default: contact.friction", kNotNegative),
            key("order", kInteger, "2: quadratic tets", Range{.min = 1, .max = 2}, Usual{"1", "linear tets"}),
            key("elastic", kBoolean, "false: no elastic energy, as for a mass-spring body",
                Usual{"true", "a body is a continuum"}),
            key("shell", kTable, "makes the body a sheet", Members{"shell"}),
            key("rod", kTable, "makes the body a rod", Members{"rod"}),
            key("material", kTable, "material", Members{"material"}, Usual{"{}"}),
            key("deform", kTable, "initial shape; default: at rest", Members{"deform"}),
            key("velocity", kExpressions, "initial velocity of free vertices, a function of the rest position",
                Units{"m/s"}, Usual{"[0.0, 0.0, 0.0]", "at rest"}),
            key("angular_velocity", kNumbers, "adds omega x (x - center of mass) to the velocity", Units{"rad/s"},
                Usual{"[0.0, 0.0, 0.0]", "at rest"}),
            key("damping", kTable, "damping", Members{"damping"}, Usual{"{}"}),
            key("viscoelastic", kTables, "branches for creep and relaxation", Members{"viscoelastic"}),
            key("fibre", kTables, "families of fibres", Members{"fibre"}),
            key("muscle", kTables, "active fibres", Members{"muscle"}),
            key("pin", kTables, "prescribed positions", Members{"pin"}),
            key("spring", kTables, "springs", Members{"spring"}),
            key("grab", kTables, "points dragged along a path", Members{"grab"}),
            key("traction", kTables, "dead loads on the surface", Members{"traction"}),
            key("pressure", kTables, "follower pressures", Members{"pressure"}),
            key("cavity", kTables, "gas or liquid in a cavity", Members{"cavity"}),
            key("force", kTables, "dead loads per volume", Members{"force"})});
  add_section(
      s,
      {"shell", "shell = { ... } in a [[body]]",
       "A sheet, such as cloth: the triangles of `mesh` or `shape` (of solids: their surface, hollow), neo-Hookean in "
       "plane stress."},
      {key("thickness", kNumber, "thickness", Units{"m"}, kPositive, kRequired),
       key("moment", kNumber, "bending stiffness D; default: E t^3 / (12 (1 - nu^2))", Units{"N m"}, kNotNegative),
       key("bending", kText,
           "`hinge`: fast, but the stiffness depends on the mesh; `mid_edge`: converges as the mesh is refined, with "
           "one "
           "unknown angle per edge. A row of triangles with three pinned vertices clamps the sheet",
           Choices{{"hinge", "mid_edge"}}, Usual{"\"hinge\"", "for cloth"}),
       key("rest", kText, "angles between triangles at rest", Choices{{"mesh", "flat"}},
           Usual{"\"mesh\"", "those of the mesh"}),
       key("yield", kNumber,
           "moment per length beyond which a fold stays, as a crease of paper or a bend of sheet metal; default: none. "
           "Works with `hinge`, backward_euler and quasi_static; damping.stiffness then damps stretching alone",
           Units{"N"}, kPositive),
       key("limit", kNumber | kTable,
           "limit of the principal stretches: `to`, or from where it acts and where it ends; default: none",
           Members{"limit"}),
       key("pattern", kTable, "flat rest shapes of the triangles; default: those of the mesh", Members{"pattern"}),
       key("weave", kTable, "orthotropic fabric", Members{"weave"})});
  add_section(s,
              {"limit", "limit = TO or { ... } in a shell",
               "Adds -E (s - from)^2 ln((to - s) / (to - from)) to the energy density for each principal stretch s > "
               "from, E the Young's modulus. It is infinite from `to` on, so no triangle is stretched that far."},
              {key("to", kNumber, "stretch that is not reached, > 1", kRequired),
               key("from", kNumber, "stretch from which the limit acts, in [1, to); default: (1 + to) / 2")});
  add_section(s,
              {"pattern", "pattern = { ... } in a shell",
               "The pieces of a sewing pattern: triangles have the rest shapes of their texture coordinates in the OBJ "
               "file `mesh`, so darts and gathered seams pull the sheet into shape. Mass and stretching use them; "
               "bending keeps the lengths of the mesh, and its angles unless rest = \"flat\". Pieces may be mirrored. "
               "`weave.warp` is a direction in the pattern: [1, 0, 0] along u, [0, 1, 0] along v."},
              {key("uv_scale", kNumber,
                   "length of the unit of u and v after `scale` of the body; a note gives the one that keeps the area",
                   Units{"m"}, kPositive, kRequired)});
  add_section(s,
              {"weave", "weave = { ... } in a shell",
               "Orthotropic Saint Venant-Kirchhoff material: `young` of the material along the warp, `poisson` for "
               "stretch along the warp."},
              {key("weft", kNumber, "Young's modulus of the weft", Units{"Pa"}, kPositive, kRequired),
               key("shear", kNumber, "shear modulus of warp and weft", Units{"Pa"}, kPositive, kRequired),
               key("warp", kNumbers, "direction of the warp in the rest shape, projected onto each triangle",
                   Usual{"[1.0, 0.0, 0.0]", "along x"})});
  add_section(
      s,
      {"rod", "rod = { ... } in a [[body]]",
       "A thin round rod, such as a cable or a hair: the lines of `mesh` (`l` of OBJ, line cells of VTU) or a `shape`. "
       "It stretches with E A, bends with E I and twists with G J of `material`. Two pinned vertices of a segment "
       "clamp "
       "it. Works with backward_euler and quasi_static."},
      {key("radius", kNumber, "radius of the cross-section", Units{"m"}, kPositive, kRequired),
       key("rest", kText, "curvature at rest", Choices{{"mesh", "straight"}}, Usual{"\"mesh\"", "that of the mesh"}),
       key("natural_twist", kNumber, "twist at rest", Units{"rad/m"}, Range{-1e9, 1e9}, Usual{"0.0", "none"}),
       key("twist_first", kNumber | kMovingExpression,
           "angle by which the first segment is turned about its axis; function of the time t; default: 0 if both of "
           "its vertices are pinned, else free",
           Units{"rad"}),
       key("twist_last", kNumber | kMovingExpression, "the same of the last segment", Units{"rad"})});
  s.alternatives.push_back({"body", {{"mesh", "mesh_size"}, {"shape"}}, true});
  s.alternatives.push_back({"body", {{"shell"}, {"rod"}}, false});
}

void add_shapes(Schema& s) {
  const auto length = [&](const char* section, const char* name, const char* meaning) {
    add_keys(s, section, {key(name, kNumber, meaning, Units{"m"}, kPositive, kRequired)});
  };
  const auto shape = [&](const char* name, const char* meaning) {
    add_keys(s, "shape", {key(name, kTable, meaning, Members{name})});
  };
  s.sections.push_back({"shape", "shape = { ... } in a [[body]]", "A generated mesh."});
  shape("box", "a box along the axes");
  shape("cylinder", "from z = 0 to z = height");
  shape("sphere", "about the origin");
  shape("torus", "about the z axis");
  shape("chamber", "a hollow ellipsoid about the z axis, open above");
  shape("rectangle", "a sheet about the origin, normal to z");
  shape("disc", "a round sheet about the origin, normal to z");
  shape("tube", "an open tube from z = 0 to z = height, a sheet");
  shape("line", "a straight rod");
  shape("ring", "a closed rod about the origin, normal to z");
  shape("coil", "a helix about the z axis, a rod");
  s.alternatives.push_back({"shape",
                            {{"box"},
                             {"cylinder"},
                             {"sphere"},
                             {"torus"},
                             {"chamber"},
                             {"rectangle"},
                             {"disc"},
                             {"tube"},
                             {"line"},
                             {"ring"},
                             {"coil"}},
                            true});

  add_section(s, {"box", "box = { ... }", "A box cut into cells, each into tets."},
              {key("lower", kNumbers, "lowest corner", Units{"m"}, Usual{"[0.0, 0.0, 0.0]", "the origin"}),
               key("upper", kNumbers, "highest corner", Units{"m"}, kRequired),
               key("cells", kIntegers, "cells along x, y and z", Range{.min = 1, .max = 10000}, kRequired),
               key("size", kNumber, "approximate edge length", Units{"m"}, kPositive, kRequired),
               key("cut", kText, "six tets per cell, or five, alternating", Choices{{"kuhn", "five"}},
                   Usual{"\"kuhn\"", "refines uniformly"})});
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
  s.sections.push_back({"chamber", "chamber = { ... }",
                        "A hollow ellipsoid about the z axis with its center at the origin and its tip below, cut off "
                        "at the base: an idealized chamber of the heart."});
  length("chamber", "inner_radius", "semi-axis of the cavity across z");
  length("chamber", "inner_length", "semi-axis of the cavity along z");
  length("chamber", "outer_radius", "semi-axis of the outer surface across z");
  length("chamber", "outer_length", "semi-axis of the outer surface along z");
  add_keys(s, "chamber", {key("base", kNumber, "z of the cut", Units{"m"}, Usual{"0.0", "half an ellipsoid"})});
  length("chamber", "size", "approximate edge length along the axis");
  s.sections.push_back({"rectangle", "rectangle = { ... }", "A sheet in the plane z = 0 about the origin."});
  length("rectangle", "width", "length along x");
  length("rectangle", "height", "length along y");
  length("rectangle", "size", "approximate edge length");
  s.sections.push_back({"disc", "disc = { ... }", "A round sheet in the plane z = 0 about the origin."});
  length("disc", "radius", "radius");
  length("disc", "size", "approximate edge length");
  s.sections.push_back({"tube", "tube = { ... }", "An open tube about the z axis, a sheet."});
  length("tube", "radius", "radius");
  length("tube", "height", "length along z");
  length("tube", "size", "approximate edge length");
  add_section(s, {"line", "line = { ... }", "A straight polyline of a rod."},
              {key("from", kNumbers, "first vertex", Units{"m"}, Usual{"[0.0, 0.0, 0.0]", "the origin"}),
               key("to", kNumbers, "last vertex", Units{"m"}, kRequired)});
  length("line", "size", "approximate length of a segment");
  s.sections.push_back({"ring", "ring = { ... }", "A closed polyline of a rod in the plane z = 0."});
  length("ring", "radius", "radius");
  length("ring", "size", "approximate length of a segment");
  s.sections.push_back({"coil", "coil = { ... }", "A right-handed helix from (radius, 0, 0) upward."});
  length("coil", "radius", "radius");
  length("coil", "pitch", "height of a turn");
  add_keys(s, "coil", {key("turns", kNumber, "number of turns", kPositive, kRequired)});
  length("coil", "size", "approximate length of a segment");
}

void add_placement(Schema& s) {
  add_section(s, {"rotate", "rotate = { ... } in a [[body]]", "A rotation about the origin."},
              {key("axis", kNumbers, "any nonzero vector", kRequired),
               key("angle_deg", kNumber, "right-handed", Units{"degrees"}, kRequired),
               key("euler_deg", kNumbers, "about x, then y, then z, fixed axes", Units{"degrees"})});
  s.alternatives.push_back({"rotate", {{"axis", "angle_deg"}, {"euler_deg"}}, true});

  s.sections.push_back(
      {"deform", "deform = { ... } in a [[body]]",
       "The shape at time 0 relative to the placed rest shape, about the center of its bounding box."});
  add_keys(s, "deform",
           {key("scale", kNumber | kNumbers, "stretch", Range{.min = 0}),
            key("matrix", kMatrix, "deformation gradient by rows"),
            key("twist", kTable, "twist about an axis", Members{"twist"}),
            key("displacement", kExpressions, "function of the rest position (X, Y, Z)", Units{"m"}),
            key("file", kText, "CSV with a displacement x,y,z per vertex", Units{"m"}, kRequired),
            key("hash", kText, "hash of the file, in resolved scenes")});
  s.alternatives.push_back({"deform", {{"scale"}, {"matrix"}, {"twist"}, {"displacement"}, {"file", "hash"}}, true});

  s.sections.push_back(
      {"twist", "twist = { ... } in deform", "A rotation proportional to the distance along the axis."});
  add_keys(s, "twist",
           {key("axis", kNumbers, "through the center", kRequired),
            key("angle_deg", kNumber, "between the ends of the body", Units{"degrees"}, kRequired)});
}

}  // namespace

void add_placement_keys(Schema& s, const char* section) {
  add_keys(s, section,
           {key("scale", kNumber | kNumbers, "scale factor about the origin", kPositive,
                Usual{"1.0", "the file is in meters"}),
            key("rotate", kTable, "rotation about the origin", Members{"rotate"}),
            key("translate", kNumbers, "translation", Units{"m"}, Usual{"[0.0, 0.0, 0.0]", "stays where it is"})});
}

void add_body_sections(Schema& s) {
  add_body(s);
  add_shapes(s);
  add_placement(s);
}

}  // namespace aspic
