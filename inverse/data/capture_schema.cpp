#include "data/capture_schema.h"

#include <algorithm>

#include "data/units.h"
#include "scene/schema_table.h"

namespace aspic {
namespace {

// Sections shared with scenes: selections and values per tet.
void add_sections_of_scenes(Schema& s) {
  const Schema& scenes = scene_schema();
  const auto is_shared = [](const std::string& section) {
    return section == "where" || section == "region_box" || section == "region_sphere" || section == "field";
  };
  for (const Section& section : scenes.sections)
    if (is_shared(section.name)) s.sections.push_back(section);
  for (const Key& key : scenes.keys)
    if (is_shared(key.section)) s.keys.push_back(key);
  for (const Alternatives& a : scenes.alternatives)
    if (is_shared(a.section)) s.alternatives.push_back(a);
}

void add_document(Schema& s) {
  add_keys(
      s, "capture",
      {key("version", kInteger, "of this format", Range{.min = 1, .max = 1}, kRequired),
       key("name", kText, "of the data set; default: the folder's name"),
       key("mesh", kText, "tet mesh of the body at rest", kRequired),
       key("mesh_gravity", kNumbers, "acceleration of gravity when the mesh was scanned; default: the mesh is unloaded",
           Units{"gravity"}),
       key("order", kInteger, "of its tets; default: 2 up to 2000 tets, 1 above", Range{.min = 1, .max = 2}),
       key("fixed", kExpression | kTable | kIntegers, "held vertices; default: none", Members{"where"}),
       key("density", kNumber | kExpression | kTable, "for gravity", Units{"kg/m^3"}, Range{.min = 0}, Members{"field"},
           Usual{"1000.0"}),
       key("up", kNumbers, "for selections by height", Usual{"[0.0, 1.0, 0.0]"}),
       key("markers", kText, "table of markers", Usual{"\"markers.csv\""}),
       key("cases", kText, "table of load cases", Usual{"\"cases.csv\""}),
       key("positions", kText, "table of positions", Usual{"\"positions.csv\""}),
       key("registration", kText,
           "motion from the coordinates of the markers to those of the mesh, as --register writes it"),
       key("scan", kText, "surface at rest in the coordinates of the markers, for --register"),
       key("forces", kText, "time series of force, for cases with a time"),
       key("steady", kNumber | kText,
           "duration of a steady force; \"off\" takes the force as it is; \"history\": cases with a time are waypoints "
           "of loads that vary in time; default: a 20th of the series",
           Units{"s"}, kPositive, Choices{{"off", "history"}}),
       key("units", kTable, "of the tables", Members{"units"}, Usual{"{}"}),
       key("columns", kTable, "names of columns", Members{"columns"}, Usual{"{}"}),
       key("deviation", kTable, "of readings", Members{"deviation"}, Usual{"{}"}),
       key("errors", kTable, "standard deviations of systematic errors", Members{"errors"}, Usual{"{}"}),
       key("force_of", kText, "whose force on the other was measured", Choices{{"tip", "body"}}, Usual{"\"tip\""}),
       key("tip", kTables, "tips of probes", Members{"tip"}),
       key("grip", kTables, "clamps of a rig", Members{"grip"}),
       key("patch", kTables, "patches under pressure", Members{"patch"})});
}

void add_indenters_and_patches(Schema& s) {
  add_keys(s, "tip",
           {key("name", kText, "as the table of cases calls it", Usual{"\"tip\""}),
            key("shape", kText, "disc: flat, with a rounded rim", Choices{{"sphere", "disc"}}, Usual{"\"sphere\""}),
            key("contact", kText, "bonded: follows the tip from the touch on", Choices{{"sliding", "bonded"}},
                Usual{"\"sliding\""}),
            key("radius", kNumber, "of the tip", Units{"length"}, kPositive, kRequired),
            key("rim", kNumber, "radius of the rounded rim of a sliding disc; default: unknown", Units{"length"},
                kNotNegative),
            key("stiffness", kNumber, "of its elastic layer; default: far above the estimated stiffness of the body",
                Units{"Pa/m"}, kPositive),
            key("stiffness_deviation", kNumber | kText, "of the logarithm of a given stiffness", kNotNegative,
                Choices{{"unknown"}}, Usual{"0.0"}),
            key("friction", kNumber, "coefficient, of a sliding tip", kNotNegative, Usual{"0.0"}),
            key("friction_deviation", kNumber, "of the logarithm of friction", kNotNegative, Usual{"0.0"})});
  add_keys(s, "grip",
           {key("name", kText, "as the table of cases calls it", Usual{"\"grip\""}),
            key("where", kExpression | kTable | kIntegers, "vertices that it moves", kRequired, Members{"where"}),
            key("center", kNumbers, "of rotations and torques, at rest; default: the mean of its vertices",
                Units{"length"})});
  add_keys(s, "patch",
           {key("name", kText, "as the table of cases calls it", Usual{"\"patch\""}),
            key("where", kExpression | kTable, "boundary triangles, by centroid", Members{"where"}),
            key("triangles", kText, "a table with the corners a, b, c of each")});
  s.alternatives.push_back({"patch", {{"where"}, {"triangles"}}, true});
}

void add_units(Schema& s) {
  for (const char* quantity : {"length", "mesh", "recording", "force", "torque", "angle", "pressure", "gravity"})
    add_keys(s, "units", {key(quantity, kText, "of this quantity", Choices{unit_names(quantity)})});
  add_keys(s, "deviation",
           {key("position", kNumber, "of positions", Units{"length"}, kPositive),
            key("force", kNumber, "of forces", Units{"force"}, kPositive),
            key("torque", kNumber, "of torques", Units{"torque"}, kPositive)});
}

void add_errors(Schema& s) {
  add_keys(s, "errors",
           {key("position", kNumber, "of an indenter or grip, along x, y and z, per group", Units{"length"}, kPositive),
            key("rotation", kNumber, "of an indenter or grip, about x, y and z, per group", Units{"angle"}, kPositive),
            key("backlash", kNumber, "lost motion along the way of an indenter or grip, per session", Units{"length"},
                kPositive),
            key("tare", kNumber, "offset of the force, along x, y and z, per session", Units{"force"}, kPositive),
            key("force_scale", kNumber, "relative, of forces and torques, per session", kPositive),
            key("length_scale", kNumber, "relative, of the motions of markers, per session", kPositive)});
}

void add_columns(Schema& s) {
  std::vector<std::string> all;
  const auto add_table = [&](const char* section, const std::vector<std::string>& names) {
    for (const std::string& name : names) {
      add_keys(s, section, {key(name, kText, "its name in the table")});
      if (std::find(all.begin(), all.end(), name) == all.end()) all.push_back(name);
    }
  };
  add_table("columns_of_markers", marker_columns());
  add_table("columns_of_cases", case_columns());
  add_table("columns_of_positions", position_columns());
  add_table("columns_of_forces", series_columns());
  for (const std::string& name : all) add_keys(s, "columns", {key(name, kText, "its name in all tables")});
  for (const char* table : {"markers", "cases", "positions", "forces"})
    add_keys(s, "columns",
             {key(table, kTable, "names in this table alone", Members{std::string("columns_of_") + table})});
}

}  // namespace

const std::vector<std::string>& marker_columns() {
  static const std::vector<std::string> names = {"marker",   "vertex",   "x",        "y",        "z",       "corner_1",
                                                 "corner_2", "corner_3", "weight_1", "weight_2", "weight_3"};
  return names;
}

const std::vector<std::string>& case_columns() {
  static const std::vector<std::string> names = {
      "case",      "group",       "session",     "frame",         "time",       "grip",       "move_x",     "move_y",
      "move_z",    "tip",         "touch_x",     "touch_y",       "touch_z",    "axis_x",     "axis_y",     "axis_z",
      "center_x",  "center_y",    "center_z",    "depth",         "rotation_x", "rotation_y", "rotation_z", "gravity_x",
      "gravity_y", "gravity_z",   "pressure",    "dead_pressure", "patch",      "force",      "force_x",    "force_y",
      "force_z",   "force_sd",    "force_sd_x",  "force_sd_y",    "force_sd_z", "torque_x",   "torque_y",   "torque_z",
      "torque_sd", "torque_sd_x", "torque_sd_y", "torque_sd_z"};
  return names;
}

const std::vector<std::string>& position_columns() {
  static const std::vector<std::string> names = {"case", "marker", "x", "y", "z", "sd", "sd_x", "sd_y", "sd_z"};
  return names;
}

const std::vector<std::string>& series_columns() {
  static const std::vector<std::string> names = {"time", "force", "force_x", "force_y", "force_z"};
  return names;
}

const Schema& capture_schema() {
  static const Schema schema = [] {
    Schema s;
    add_document(s);
    add_indenters_and_patches(s);
    add_units(s);
    add_errors(s);
    add_columns(s);
    add_sections_of_scenes(s);
    return s;
  }();
  return schema;
}

}  // namespace aspic
