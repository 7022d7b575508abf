// Schema of contact and obstacles.
#include "scene/schema_table.h"

namespace aspic {

void add_contact_sections(Schema& s) {
  add_keys(s, "scene",
           {key("contact", kTable, "switches contact on: bodies touch each other, themselves and obstacles",
                Members{"contact"}),
            key("obstacle", kTables, "surfaces with prescribed motion; they switch contact on", Members{"obstacle"})});
  add_section(
      s, {"contact", "[contact]", "Contact with friction. The defaults suit most scenes."},
      {key("friction", kNumber,
           "coefficient of friction of bodies and obstacles without their own; that of a pair is the geometric mean, "
           "unless `pair` gives another",
           kNotNegative, Usual{"0.0", "none; rubber on a smooth floor has 0.3 to 0.8"}),
       key("reach", kNumber,
           "distance at which contact forces begin; default, per pair: a tenth (in statics a fiftieth) of the mean "
           "edge of the finer "
           "surface, at "
           "most a fifth of the gap at the start and a tenth of the thickness of a thin part",
           Units{"m"}, kPositive),
       key("stiffness", kNumber, "pressure scale of contact forces; default: a tenth of the smaller Young's modulus",
           Units{"Pa"}, kPositive),
       key("creep", kNumber,
           "largest speed of surfaces that stick; default: 1e-4 sqrt(9.81 m/s^2 L) for bodies of size L", Units{"m/s"},
           kPositive),
       key("start", kText,
           "`apart`: overlap is an error, but surfaces may touch; `inflate`: bodies without pins that overlap shrink, "
           "then "
           "grow back in contact",
           Choices{{"apart", "inflate"}}, Usual{"\"apart\"", "overlap is most often a mistake"}),
       key("pair", kTables, "friction of single pairs", Members{"pair"})});
  add_section(s, {"pair", "[[contact.pair]]", "Friction between two bodies or obstacles, or within a body."},
              {key("between", kNames, "two names; equal: self-contact", kRequired),
               key("friction", kNumber, "coefficient", kNotNegative, kRequired)});

  add_section(s,
              {"obstacle", "[[obstacle]]",
               "A surface with prescribed motion, or at rest. Meshes and shapes are "
               "placed by scale, rotate, translate in this order."},
              {key("name", kText, "default: obstacle1, obstacle2, ..."),
               key("plane", kTable, "an infinite plane", Members{"plane"}),
               key("sphere", kTable, "an exact sphere", Members{"obstacle_sphere"}),
               key("capsule", kTable, "a segment with a radius", Members{"capsule"}),
               key("mesh", kText, "triangle mesh, open or closed", kRequired),
               key("hash", kText, "hash of the file, in resolved scenes"),
               key("shape", kTable, "the boundary of a generated shape", Members{"shape"}),
               key("motion", kText | kTable, "prescribed motion; only meshes and shapes rotate", Choices{{"fixed"}},
                   Members{"motion"}, Usual{"\"fixed\"", "most obstacles are at rest"}),
               key("recording", kTable, "recorded positions of the vertices of `mesh`, instead of `motion`",
                   Members{"recording"}),
               key("friction", kNumber, "default: contact.friction", kNotNegative)});
  add_placement_keys(s, "obstacle");
  s.alternatives.push_back({"obstacle", {{"plane"}, {"sphere"}, {"capsule"}, {"mesh", "hash"}, {"shape"}}, true});
  const auto add_point = [&s](const char* table, const char* name, const char* meaning) {
    add_keys(s, table, {key(name, kNumbers, meaning, Units{"m"}, kRequired)});
  };
  const auto add_radius = [&s](const char* table) {
    add_keys(s, table, {key("radius", kNumber, "radius", Units{"m"}, kPositive, kRequired)});
  };
  add_section(
      s,
      {"recording", "recording = { ... } in an [[obstacle]] or a motion",
       "A motion as Blender writes it; placed like the mesh."},
      {key("file", kText, "PC2 point cache, or glTF with an animation of nodes or of the joints of skins", kRequired),
       key("hash", kText, "hash of the file, in resolved scenes"),
       key("animation", kText, "name of the animation; needed if the glTF file has several"),
       key("mesh", kText, "only in a motion: the recorded surface at rest, placed like the body's mesh"),
       key("mesh_hash", kText, "hash of that file, in resolved scenes"),
       key("fps", kNumber, "frames per second; samples per second of a glTF file", Units{"1/s"}, kPositive,
           Usual{"24.0", "the default of Blender"})});
  s.sections.push_back({"obstacle_sphere", "sphere = { ... } in an [[obstacle]]", "A sphere without facets."});
  add_point("obstacle_sphere", "center", "center");
  add_radius("obstacle_sphere");
  s.sections.push_back({"capsule", "capsule = { ... } in an [[obstacle]]", "The points within a radius of a segment."});
  add_point("capsule", "from", "one end of the segment");
  add_point("capsule", "to", "the other end");
  add_radius("capsule");
  add_section(
      s, {"plane", "plane = { ... } in an [[obstacle]]", "A half-space that bodies stay out of."},
      {key("origin", kNumbers, "a point of the plane", Units{"m"}, Usual{"[0.0, 0.0, 0.0]", "a floor at height 0"}),
       key("normal", kNumbers, "direction of the free side, any length but 0",
           Usual{"[0.0, 1.0, 0.0]", "a floor under gravity along -y"})});
}

}  // namespace aspic
