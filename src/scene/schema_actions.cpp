// Schema of pins, motions, loads and damping.
#include "scene/schema_table.h"

namespace aspic {
namespace {

void add_damping(Schema& s) {
  add_section(s, {"damping", "damping = { ... } in a [[body]]", "Dissipation besides that of the integrator."},
              {key("mass", kNumber, "Rayleigh a of C = a M + b K", Units{"1/s"}, kNotNegative, Usual{"0.0", "none"}),
               key("stiffness", kNumber, "Rayleigh b of C = a M + b K", Units{"s"}, kNotNegative, Usual{"0.0", "none"}),
               key("viscosity", kNumber | kExpression | kTable, "strain-rate damping, zero for rigid rotations",
                   Units{"Pa s"}, kNotNegative, Members{"field"}, Usual{"0.0", "none"})});
}

void add_viscoelastic(Schema& s) {
  const auto per_tet = kNumber | kExpression | kTable;
  add_section(
      s,
      {"viscoelastic", "[[body.viscoelastic]]",
       "A Maxwell branch beside the material, for creep and relaxation: a stress s in the rest frame, zero at the "
       "start, with s' + s / tau = 2 G E', E = (F'F - I)/2. The material is the response to slow loads; fast ones add "
       "the branches. Requires the integrator `backward_euler`, `linearly_implicit_euler` or `quasi_static`; time "
       "passes in the latter, too."},
      {key("shear", per_tet, "shear modulus G", Units{"Pa"}, kNotNegative, Members{"field"}, kRequired),
       key("ratio", per_tet, "G over the shear modulus of the material", kNotNegative, Members{"field"}, kRequired),
       key("relaxation_time", kNumber, "tau", Units{"s"}, kPositive, kRequired)});
  s.alternatives.push_back({"viscoelastic", {{"shear"}, {"ratio"}}, true});
}

// The groups of keys that give directions.
std::vector<Key> direction_keys() {
  const auto where = kExpression | kTable;
  return {key("direction", kExpressions, "a, of any length: function of the place (X, Y, Z) at rest", kRequired),
          key("from", where, "fibres run from here, like the flow of a potential ...", Members{"where"}, kRequired),
          key("to", where, "... to here, such as from origin to insertion", Members{"where"}, kRequired),
          key("helix", kTable, "fibres wind around an axis, as in the wall of the heart", Members{"helix"}, kRequired),
          key("directions", kTable, "a from a file", Members{"directions"}, kRequired)};
}

void add_directions(Schema& s) {
  const auto where = kExpression | kTable;
  const auto angle = [](const char* name, const char* meaning, Usual usual) {
    return key(name, kNumber, meaning, Units{"degrees"}, Range{.min = -180, .max = 180}, std::move(usual));
  };
  add_section(s,
              {"helix", "helix = { ... } in a fibre or muscle",
               "Fibres in the wall, at an angle to the circumference that changes from the inner to the outer surface "
               "with a potential between them [Bayer 2012]."},
              {key("inner", where, "inner surface", Members{"where"}, kRequired),
               key("outer", where, "outer surface", Members{"where"}, kRequired),
               key("axis", kNumbers, "from the apex to the base, of any length", Usual{"[0.0, 0.0, 1.0]", "along z"}),
               angle("inner_angle_deg",
                     "inner angle: 0 along the circumference, counterclockwise seen from the base; 90 "
                     "along the axis",
                     {"60.0", "measured in hearts"}),
               angle("outer_angle_deg", "outer angle", {"-60.0", "measured in hearts"})});
  add_section(s,
              {"directions", "directions = { ... } in a fibre or muscle",
               "Vectors of any length in a VTU file, per tet or per vertex, or three numbers per tet in a text file."},
              {key("file", kText, "VTU file, or text with a line per tet", kRequired),
               key("name", kText, "field of a VTU file"), key("hash", kText, "hash of the file, in resolved scenes")});
}

void add_fibres(Schema& s) {
  const auto per_tet = kNumber | kExpression | kTable;
  const std::vector<std::vector<std::string>> directions = {{"direction"}, {"from", "to"}, {"helix"}, {"directions"}};
  s.sections.push_back(
      {"fibre", "[[body.fibre]]",
       "Fibres along a in the tets, beside the material. `gasser`: k1/(2 k2) (exp(k2 E^2) - 1) in tension, E = H : F'F "
       "- 1, H = kappa I + (1 - 3 kappa) a a' [Gasser 2006]. `guccione`: C/2 (exp(Q) - 1), Q = bf Eaa^2 + bt (Ess^2 + "
       "Enn^2 + 2 Esn^2) + 2 bfs (Eas^2 + Ean^2) with the Green strain E [Guccione 1991]. `weiss`: l dpsi/dl = C3 "
       "(exp(C4 (l - 1)) - 1) for stretches 1 < l < l*, then linear with the slope C5 [Weiss 1996]."});
  add_keys(s, "fibre", direction_keys());
  add_keys(s, "fibre",
           {key("law", kText, "energy of the fibres", Choices{{"gasser", "guccione", "weiss"}},
                Usual{"\"gasser\"", "collagen with dispersion"}),
            key("stiffness", per_tet, "k1, C or C3", Units{"Pa"}, kNotNegative, Members{"field"}, kRequired),
            key("exponent", per_tet, "k2 or C4", Range{.min = 1e-3, .max = 1e6}, Members{"field"},
                Usual{"1.0", "moderate stiffening"}),
            key("dispersion", per_tet, "kappa: 0 along a, 1/3 in all directions", Range{.min = 0, .max = 1.0 / 3},
                Members{"field"}, Usual{"0.0", "all along a"}),
            key("along", per_tet, "bf of guccione", kNotNegative, Members{"field"}),
            key("across", per_tet, "bt of guccione", kNotNegative, Members{"field"}),
            key("shear", per_tet, "bfs of guccione", kNotNegative, Members{"field"}),
            key("straight_stretch", per_tet, "l* of weiss", Range{.min = 1, .min_open = true}, Members{"field"}),
            key("straight_stiffness", per_tet, "C5 of weiss", Units{"Pa"}, kNotNegative, Members{"field"})});
  s.alternatives.push_back({"fibre", directions, true});

  s.sections.push_back(
      {"muscle", "[[body.muscle]]",
       "Active fibres along a, beside the material. `blemker`: their nominal stress is strength * activation at the "
       "optimal stretch and falls to 0 at 0.4 and 1.6 times of it [Blemker 2005]; with `max_velocity` it also depends "
       "on the velocity, (1 - v)/(1 + v/k) in shortening [Hill 1938]. `tension`: energy strength * activation / 2 "
       "(|F a|^2 - 1), a stress that does not depend on the stretch [Land 2015]."});
  add_keys(s, "muscle", direction_keys());
  add_keys(s, "muscle",
           {key("law", kText, "energy of the fibres", Choices{{"blemker", "tension"}},
                Usual{"\"blemker\"", "skeletal muscle"}),
            key("strength", per_tet, "largest active stress", Units{"Pa"}, kNotNegative, Members{"field"}, kRequired),
            key("activation", kNumber | kMovingExpression | kTables,
                "0 (passive) to 1: function of the time t, or values at times", Members{"activation"}, kRequired),
            key("optimal_stretch", per_tet, "stretch of the largest force", kPositive, Members{"field"},
                Usual{"1.0", "the rest shape"}),
            key("max_velocity", per_tet, "v = 1: optimal lengths per second without load; default: any", Units{"1/s"},
                kPositive, Members{"field"}),
            key("curvature", per_tet, "k of the force-velocity curve", kPositive, Members{"field"},
                Usual{"0.25", "most muscles"}),
            key("lengthening", per_tet, "relative force of fast lengthening",
                Range{.min = 1, .max = 10, .min_open = true}, Members{"field"}, Usual{"1.5", "most muscles"})});
  s.alternatives.push_back({"muscle", directions, true});
  add_section(s,
              {"activation", "activation = [{ ... }, ...] in a muscle",
               "A value at a time: linear between them, constant before and after."},
              {key("time", kNumber, "ascending", Units{"s"}, kNotNegative, kRequired),
               key("level", kNumber, "activation", Range{.min = 0, .max = 1}, kRequired)});
  add_directions(s);
}

void add_where(Schema& s) {
  s.sections.push_back(
      {"where", "where = ... of a pin, spring, traction, pressure, force or attachment",
       "A selection by rest position: vertices, boundary triangles or tets (by centroid). A string is a formula of "
       "X, Y, Z (or x, y, z) that is nonzero where selected: \"y > 0.9 && x < 0\"."});
  add_keys(
      s, "where",
      {key("box", kTable, "inside a box", Members{"region_box"}),
       key("sphere", kTable, "inside a sphere", Members{"region_sphere"}),
       key("vertices", kIntegers, "indices in the body, from 0; triangles and tets with all corners in the list",
           kNotNegative),
       key("surface", kText | kInteger,
           "name or number of a [surface of the mesh file](formats.md#names-of-surfaces-and-regions); vertices and "
           "boundary triangles"),
       key("lowest", kNumber, "lowest fraction of the body's height, along gravity (or -y)", Range{.min = 0, .max = 1}),
       key("highest", kNumber, "highest fraction of the body's height", Range{.min = 0, .max = 1}),
       key("file", kText, "[painted surface](formats.md#painted-surfaces); triangles and tets as with `vertices`",
           kRequired),
       key("name", kText, "its attribute", kRequired),
       key("above", kNumber, "selects larger values", Usual{"0.5", "half of full paint"}),
       key("hash", kText, "hash of the file, in resolved scenes")});
  s.alternatives.push_back(
      {"where",
       {{"box"}, {"sphere"}, {"vertices"}, {"surface"}, {"lowest"}, {"highest"}, {"file", "name", "above", "hash"}},
       true});

  add_section(s, {"region_box", "box = { ... } in where", "A closed box."},
              {key("lower", kNumbers, "lowest corner", Units{"m"}, kRequired),
               key("upper", kNumbers, "highest corner", Units{"m"}, kRequired)});
  add_section(s, {"region_sphere", "sphere = { ... } in where", "A closed ball."},
              {key("center", kNumbers, "center", Units{"m"}, kRequired),
               key("radius", kNumber, "radius", Units{"m"}, kPositive, kRequired)});
}

void add_motion(Schema& s) {
  add_section(
      s,
      {"motion", "motion = \"fixed\" or { ... }",
       "Motion of pinned vertices, spring targets or obstacles from their positions at time 0."},
      {key("linear", kTable, "constant velocity", Members{"linear"}),
       key("rotate", kTable, "constant rotation", Members{"spin"}),
       key("keyframes", kTables, "piecewise linear displacements, constant before and after", Members{"keyframe"}),
       key("displacement", kMovingExpressions, "function of the position (X, Y, Z) at time 0 and of the time t",
           Units{"m"}),
       key("recording", kTable, "motion of a recorded surface (pins and springs)", Members{"recording"})});
  s.alternatives.push_back({"motion", {{"linear"}, {"rotate"}, {"keyframes"}, {"displacement"}, {"recording"}}, true});

  const Key until = key("until", kNumber, "end of the motion; default: never", Units{"s"}, kNotNegative);
  add_section(s, {"linear", "linear = { ... } in motion", "A translation."},
              {key("velocity", kNumbers, "velocity", Units{"m/s"}, kRequired), until});
  add_section(s, {"spin", "rotate = { ... } in motion", "A rotation."},
              {key("axis", kNumbers, "any nonzero vector", kRequired),
               key("center", kNumbers, "point on the axis; default: mean of the vertices", Units{"m"}),
               key("rate_deg", kNumber, "right-handed", Units{"degrees/s"}, kRequired), until});
  add_section(s, {"keyframe", "keyframes = [{ ... }, ...] in motion", "A displacement at a time."},
              {key("time", kNumber, "ascending", Units{"s"}, kNotNegative, kRequired),
               key("displacement", kNumbers, "relative to time 0", Units{"m"}, kRequired)});
}

Key where_key() { return key("where", kExpression | kTable, "selection", Members{"where"}, kRequired); }

void add_pin_and_spring(Schema& s) {
  add_section(s,
              {"pin", "[[body.pin]]",
               "Prescribed positions (Dirichlet conditions): in all directions, along some axes (a roller: "
               "`axes = \"y\"`), or along one direction (a symmetry plane: its normal). Several pins may hold "
               "a vertex if they prescribe the same positions along common directions; they share the reaction. Pinned "
               "vertices have the velocity of their pin."},
              {key("name", kText, "default: pin1, pin2, ..."), where_key(),
               key("motion", kText | kTable, "prescribed motion", Choices{{"fixed"}}, Members{"motion"},
                   Usual{"\"fixed\"", "fixes the body"}),
               key("axes", kText, "fixed axes; the others are free", Choices{{"x", "y", "z", "xy", "xz", "yz", "xyz"}},
                   Usual{"\"xyz\"", "fixes the body"}),
               key("direction", kNumbers, "single fixed direction, any nonzero vector")});
  s.alternatives.push_back({"pin", {{"axes"}, {"direction"}}});

  add_section(
      s,
      {"spring", "[[body.spring]]",
       "Springs to points (`where`), between vertices (`between`), or along all edges (`edges`)."},
      {key("stiffness", kNumber, "k of V = k/2 (length - rest length)^2; times painted values of `where`", Units{"N/m"},
           kPositive, kRequired),
       where_key(), key("target", kNumbers, "common target; default: each vertex's position at time 0", Units{"m"}),
       key("motion", kText | kTable, "motion of the targets", Choices{{"fixed"}}, Members{"motion"},
           Usual{"\"fixed\"", "fixed targets"}),
       key("between", kPairs, "pairs of vertex indices, from 0", kNotNegative, kRequired),
       key("to_body", kText, "body of the second index; default: this one"),
       key("rest_length", kNumber, "default: distance at rest", Units{"m"}, kNotNegative),
       key("edges", kBoolean, "true: a spring along each edge of the tets", kRequired)});
  s.alternatives.push_back(
      {"spring", {{"where", "target", "motion"}, {"between", "to_body", "rest_length"}, {"edges"}}, true});
}

void add_grab(Schema& s) {
  add_section(s,
              {"grab", "[[body.grab]]",
               "A spring from a point of a tet to a hand that moves along a path, active during the path. The "
               "viewer saves drags in this form."},
              {key("stiffness", kNumber, "k of V = k/2 |p - hand|^2", Units{"N/m"}, kPositive, kRequired),
               key("point", kTables, "p: weighted sum of the vertices of one tet", Members{"grab_vertex"}, kRequired),
               key("path", kTables, "piecewise linear path of the hand; at least two places", Members{"grab_place"},
                   kRequired)});
  add_section(s, {"grab_vertex", "point = [{ ... }, ...] in a grab", "A vertex and its weight."},
              {key("vertex", kInteger, "index in the body, from 0", kNotNegative, kRequired),
               key("weight", kNumber, "the four weights sum to 1", kRequired)});
  add_section(s, {"grab_place", "path = [{ ... }, ...] in a grab", "A position of the hand."},
              {key("time", kNumber, "ascending", Units{"s"}, kNotNegative, kRequired),
               key("position", kNumbers, "position", Units{"m"}, kRequired)});
}

void add_attach(Schema& s) {
  add_section(
      s,
      {"attach", "[[attach]]",
       "Joins vertices of a body by springs to the nearest points of another body, or of another place of the same "
       "one: "
       "seams, and what is sewn or glued on. `attachment_gap` of steps.csv is the largest gap. Attach the finer of two "
       "borders to the coarser one. With contact, bodies must start apart, and seams close to the distance at which "
       "contact begins."},
      {key("points", kTable, "the attached vertices", Members{"attach_points"}, kRequired),
       key("to", kTable, "the target", Members{"attach_target"}, kRequired),
       key("distance", kNumber,
           "largest distance of a vertex from the target at time 0; beyond, the scene is refused; default: mean edge "
           "of "
           "the target's surface",
           Units{"m"}, kNotNegative),
       key("gap", kText, "`close` draws together: rest length 0; `keep`: the distance at time 0, in any direction",
           Choices{{"close", "keep"}}, Usual{"\"close\"", "a seam closes"}),
       key("stiffness", kNumber,
           "k of each vertex, V = k/2 (distance - rest length)^2; default: that of the softer body, Young's modulus "
           "times "
           "the thickness of a sheet or the mean edge of a solid",
           Units{"N/m"}, Range{.min = 0, .max = 1e15, .min_open = true})});
  add_section(s, {"attach_points", "points = { ... } in [[attach]]", "The attached vertices."},
              {key("body", kText, "name of the body", kRequired), where_key()});
  Key target = where_key();
  target.required = false;
  target.meaning =
      "vertices: only elements, edges and vertices with all corners among them are the target; default: the whole body";
  add_section(
      s, {"attach_target", "to = { ... } in [[attach]]", "The body or obstacle to which the vertices are attached."},
      {key("body", kText, "name of the body; the same one needs `where`", kRequired), target,
       key("obstacle", kText, "name of an obstacle: the vertices become a pin that follows its motion or recording")});
  s.alternatives.push_back({"attach_target", {{"body", "where"}, {"obstacle"}}, true});
}

void add_loads(Schema& s) {
  add_section(
      s, {"traction", "[[body.traction]]", "A dead load: force per rest area, of fixed direction."},
      {where_key(),
       key("value", kMovingExpressions, "function of the point (X, Y, Z) at rest and the time t", Units{"Pa"}),
       key("dead_pressure", kNumber | kMovingExpression,
           "along the inward normal at rest; function of the point (X, Y, Z) at rest and the time t", Units{"Pa"})});
  s.alternatives.push_back({"traction", {{"value"}, {"dead_pressure"}}, true});

  s.sections.push_back(
      {"pressure", "[[body.pressure]]",
       "A follower pressure: normal to the deformed surface, per deformed area. A note at the start states whether the "
       "patch is closed or its rim fixed, so that the load has a potential, or open: then the share of its rim has "
       "none "
       "and is updated within each step, like friction."});
  add_keys(s, "pressure",
           {where_key(), key("value", kNumber | kMovingExpression, "uniform, positive inwards; function of the time t",
                             Units{"Pa"}, kRequired)});

  Key inside = where_key();
  inside.required = false;
  inside.meaning = "faces of an inner surface, or of a closed sheet; default: the only one";
  add_section(
      s,
      {"cavity", "[[body.cavity]]",
       "Gas or liquid in the volume that an inner surface of a solid, or a closed sheet encloses."},
      {inside,
       key("gas", kNumber | kMovingExpression,
           "amount of gas relative to `volume` at `pressure`; function of the time t. At a constant temperature it "
           "presses with pressure * gas * volume / (present volume)"),
       key("pressure", kNumber, "pressure outside", Units{"Pa"}, kPositive, Usual{"101325.0", "air"}),
       key("liquid", kNumber | kMovingExpression, "volume of liquid relative to `volume`; function of the time t"),
       key("bulk_modulus", kNumber,
           "bulk modulus of the liquid; default: 1000 times Young's modulus of the body, of a sheet times its "
           "thickness "
           "over its extent",
           Units{"Pa"}, kPositive),
       key("volume", kNumber, "reference of the amounts; default: the enclosed volume at the start", Units{"m^3"},
           kPositive)});
  s.alternatives.push_back({"cavity", {{"gas", "pressure"}, {"liquid", "bulk_modulus"}}, true});

  s.sections.push_back({"force", "[[body.force]]", "A dead load: force per rest volume."});
  Key everywhere = where_key();
  everywhere.required = false;
  everywhere.fallback = "\"all\"";
  everywhere.reason = "the whole body";
  add_keys(s, "force",
           {everywhere, key("value", kMovingExpressions, "function of the point (X, Y, Z) at rest and the time t",
                            Units{"N/m^3"}, kRequired)});
}

}  // namespace

void add_action_sections(Schema& s) {
  add_damping(s);
  add_viscoelastic(s);
  add_fibres(s);
  add_where(s);
  add_motion(s);
  add_pin_and_spring(s);
  add_grab(s);
  add_loads(s);
  add_attach(s);
}

}  // namespace aspic
