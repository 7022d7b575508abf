#include "capture/capture_schema.h"

#include <algorithm>

#include "capture/units.h"
#include "scene/schema_table.h"

namespace aspic {
namespace {

const Range kPositive{.min = 0, .min_open = true};

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
  add_keys(s, "capture",
           {{.name = "version",
             .accepts = kInteger,
             .required = true,
             .range = {.min = 1, .max = 1},
             .meaning = "of this format"},
            {.name = "name", .accepts = kText, .meaning = "of the data set; default: the folder's name"},
            {.name = "mesh", .accepts = kText, .required = true, .meaning = "tet mesh of the body at rest"},
            {.name = "fixed",
             .accepts = kExpression | kTable | kIntegers,
             .table = "where",
             .meaning = "held vertices; default: none"},
            {.name = "density",
             .accepts = kNumber | kExpression | kTable,
             .unit = "kg/m^3",
             .fallback = "1000.0",
             .range = {.min = 0},
             .table = "field",
             .meaning = "for gravity"},
            {.name = "up", .accepts = kNumbers, .fallback = "[0.0, 1.0, 0.0]", .meaning = "for selections by height"},
            {.name = "markers", .accepts = kText, .fallback = "\"markers.csv\"", .meaning = "table of markers"},
            {.name = "cases", .accepts = kText, .fallback = "\"cases.csv\"", .meaning = "table of load cases"},
            {.name = "positions", .accepts = kText, .fallback = "\"positions.csv\"", .meaning = "table of positions"},
            {.name = "units", .accepts = kTable, .fallback = "{}", .table = "units", .meaning = "of the tables"},
            {.name = "columns", .accepts = kTable, .fallback = "{}", .table = "columns", .meaning = "names of columns"},
            {.name = "deviation", .accepts = kTable, .fallback = "{}", .table = "deviation", .meaning = "of readings"},
            {.name = "force_of",
             .accepts = kText,
             .fallback = "\"tip\"",
             .choices = {"tip", "body"},
             .meaning = "whose force on the other was measured"},
            {.name = "tip", .accepts = kTables, .table = "tip", .meaning = "tips of probes"},
            {.name = "patch", .accepts = kTables, .table = "patch", .meaning = "patches under pressure"}});
}

void add_tips_and_patches(Schema& s) {
  add_keys(s, "tip",
           {{.name = "name", .accepts = kText, .fallback = "\"tip\"", .meaning = "as the table of cases calls it"},
            {.name = "shape",
             .accepts = kText,
             .fallback = "\"sphere\"",
             .choices = {"sphere", "disc"},
             .meaning = "disc: flat, with a rounded rim"},
            {.name = "contact",
             .accepts = kText,
             .fallback = "\"sliding\"",
             .choices = {"sliding", "bonded"},
             .meaning = "bonded: glued on at the touch"},
            {.name = "radius",
             .accepts = kNumber,
             .unit = "length",
             .required = true,
             .range = kPositive,
             .meaning = "of the tip"},
            {.name = "stiffness",
             .accepts = kNumber,
             .unit = "Pa/m",
             .range = kPositive,
             .meaning = "of its elastic layer; default: far above the estimated stiffness of the body"}});
  add_keys(s, "patch",
           {{.name = "name", .accepts = kText, .fallback = "\"patch\"", .meaning = "as the table of cases calls it"},
            {.name = "where",
             .accepts = kExpression | kTable,
             .table = "where",
             .meaning = "boundary triangles, by centroid"},
            {.name = "triangles", .accepts = kText, .meaning = "a table with the corners a, b, c of each"}});
  s.alternatives.push_back({"patch", {{"where"}, {"triangles"}}, true});
}

void add_units(Schema& s) {
  for (const char* quantity : {"length", "mesh", "force", "torque", "angle", "pressure", "gravity"})
    add_key(s, "units",
            {.name = quantity, .accepts = kText, .choices = unit_names(quantity), .meaning = "of this quantity"});
  add_keys(s, "deviation",
           {{.name = "position", .accepts = kNumber, .unit = "length", .range = kPositive, .meaning = "of positions"},
            {.name = "force", .accepts = kNumber, .unit = "force", .range = kPositive, .meaning = "of forces"},
            {.name = "torque", .accepts = kNumber, .unit = "torque", .range = kPositive, .meaning = "of torques"}});
}

void add_columns(Schema& s) {
  std::vector<std::string> all;
  const auto add_table = [&](const char* section, const std::vector<std::string>& names) {
    for (const std::string& name : names) {
      add_key(s, section, {.name = name, .accepts = kText, .meaning = "its name in the table"});
      if (std::find(all.begin(), all.end(), name) == all.end()) all.push_back(name);
    }
  };
  add_table("columns_of_markers", marker_columns());
  add_table("columns_of_cases", case_columns());
  add_table("columns_of_positions", position_columns());
  for (const std::string& name : all)
    add_key(s, "columns", {.name = name, .accepts = kText, .meaning = "its name in all tables"});
  for (const char* table : {"markers", "cases", "positions"})
    add_key(s, "columns",
            {.name = table,
             .accepts = kTable,
             .table = std::string("columns_of_") + table,
             .meaning = "names in this table alone"});
}

}  // namespace

const std::vector<std::string>& marker_columns() {
  static const std::vector<std::string> names = {"marker",   "vertex",   "x",        "y",        "z",       "corner_1",
                                                 "corner_2", "corner_3", "weight_1", "weight_2", "weight_3"};
  return names;
}

const std::vector<std::string>& case_columns() {
  static const std::vector<std::string> names = {
      "case",      "group",       "tip",         "touch_x",    "touch_y",    "touch_z",    "axis_x",     "axis_y",
      "axis_z",    "center_x",    "center_y",    "center_z",   "depth",      "rotation_x", "rotation_y", "rotation_z",
      "gravity_x", "gravity_y",   "gravity_z",   "pressure",   "patch",      "force",      "force_x",    "force_y",
      "force_z",   "force_sd",    "force_sd_x",  "force_sd_y", "force_sd_z", "torque_x",   "torque_y",   "torque_z",
      "torque_sd", "torque_sd_x", "torque_sd_y", "torque_sd_z"};
  return names;
}

const std::vector<std::string>& position_columns() {
  static const std::vector<std::string> names = {"case", "marker", "x", "y", "z", "sd", "sd_x", "sd_y", "sd_z"};
  return names;
}

const Schema& capture_schema() {
  static const Schema schema = [] {
    Schema s;
    add_document(s);
    add_tips_and_patches(s);
    add_units(s);
    add_columns(s);
    add_sections_of_scenes(s);
    return s;
  }();
  return schema;
}

}  // namespace aspic
