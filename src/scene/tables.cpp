#include "scene/tables.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "base/error.h"
#include "base/number_chars.h"
#include "io/atomic_file.h"
#include "io/legacy_vtk.h"
#include "mesh/elements.h"

#include "scene/expression.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;

constexpr size_t kLongestLine = size_t{1} << 20;
constexpr size_t kMaxBeyond = 100000;  // limit of the count of excess lines for the message

// Splits a line at its separators.
std::vector<std::string_view> split_words(std::string_view line) {
  std::vector<std::string_view> words;
  while (true) {
    const size_t begin = line.find_first_not_of(",; \t\r");
    if (begin == std::string_view::npos) return words;
    const size_t end = std::min(line.find_first_of(",; \t\r", begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    line.remove_prefix(end);
  }
}

bool parse_finite(std::string_view word, double& value) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto [end, error] = from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size() && std::isfinite(value);
}

const char* elements_of(const TetMesh& mesh) {
  return !mesh.rods.empty() ? "segments" : mesh.sheet.empty() ? "tets" : "triangles";
}

std::vector<double> from_vtu(const fs::path& path, const Value& table, const TetMesh& mesh) {
  const Value* name = table.find("name");
  const Vtu vtu = read_vtk_or_vtu(path);
  std::vector<std::string> known;
  for (const Field& f : vtu.cell_fields)
    if (f.components == 1) known.push_back(f.name);
  if (!name)
    throw error_at(table["file"].place,
                   path.filename().string() + " needs `name`, its cell field" + suggestion("", known));
  for (const Field& f : vtu.cell_fields) {
    if (f.name != name->text() || f.components != 1) continue;
    if (f.values.size() != static_cast<size_t>(mesh.element_count()))
      throw error_at(name->place, path.filename().string() + " has " + std::to_string(f.values.size()) +
                                      " cells; the body has " + std::to_string(mesh.element_count()) + " " +
                                      elements_of(mesh));
    return f.values;
  }
  throw error_at(name->place, path.filename().string() + " has no cell field " + toml_string(name->text()) +
                                  " of one component" + suggestion(name->text(), known));
}

// The value of a painted element is the mean of its corners, that of the linear field at the centroid.
std::vector<double> from_painting(Table& table, const FieldScope& scope) {
  const std::vector<double>& at = scope.painted.at_vertices(table, scope.mesh);
  std::vector<double> values;
  for (const auto& [a, b, c, d] : scope.mesh.tets) values.push_back(0.25 * ((at[a] + at[b]) + (at[c] + at[d])));
  for (const auto& [a, b, c] : scope.mesh.sheet) values.push_back((at[a] + at[b] + at[c]) / 3);
  for (const auto& [a, b] : scope.mesh.rods) values.push_back(0.5 * (at[a] + at[b]));
  return values;
}

std::vector<double> from_table(Table& table, const fs::path& path, const FieldScope& scope, const std::string& stem) {
  Value view{table, {}};
  const Value& name = view["file"];
  std::vector<double> values;
  if (is_vtk_or_vtu(path)) {
    values = from_vtu(path, view, scope.mesh);
  } else {
    if (const Value* field = table.find("name"))
      throw error_at(field->place,
                     "name = " + toml_string(field->text()) + "; only VTU and PLY files have named fields");
    values = read_number_table(path, 1, static_cast<size_t>(scope.mesh.element_count()),
                               !scope.mesh.rods.empty()   ? "a segment"
                               : scope.mesh.sheet.empty() ? "a tet"
                                                          : "a triangle",
                               name.place);
  }
  check_fingerprint(table, "hash", fingerprint_of_file(path), path.string());
  table.set("file", {scope.files.keep(path, stem), {}});
  return values;
}

std::vector<double> from_file(Table& table, const FieldScope& scope, const std::string& stem) {
  const fs::path path = scope.files.find(*table.find("file"));
  std::vector<double> values = is_painted(path) ? from_painting(table, scope) : from_table(table, path, scope, stem);
  if (const Value* range = table.find("range")) {
    const double low = range->array()[0].number(), high = range->array()[1].number();
    for (double& value : values) value = (1 - value) * low + value * high;
  }
  return values;
}

// Names of a region in a scene: its label and, if the file has one, its name.
std::vector<std::string> names_of_region(int label, const MeshGroups* groups) {
  std::vector<std::string> names = {std::to_string(label)};
  if (!groups) return names;
  const auto name = groups->region_names.find(label);
  if (name != groups->region_names.end()) names.push_back(name->second);
  return names;
}

std::vector<double> from_regions(const Value& regions, const TetMesh& mesh, const MeshGroups* groups) {
  const std::set<int> labels(mesh.region.begin(), mesh.region.end());
  std::map<int, const Value*> values_of;
  std::set<std::string> known;
  std::string list;
  for (const int label : labels) {
    const std::vector<std::string> names = names_of_region(label, groups);
    for (const std::string& name : names) {
      known.insert(name);
      const Value* value = regions.find(name);
      if (value && !values_of.emplace(label, value).second)
        throw error_at(value->place,
                       "regions: region " + names[0] + " is '" + name + "' and has two values; remove one of them");
    }
    list += (list.empty() ? "" : ", ") + names[0] + (names.size() > 1 ? " '" + names[1] + "'" : "");
  }
  if (labels.empty())
    throw error_at(regions.place, "regions = " + shortened(inline_toml(regions)) +
                                      "; the mesh has no region labels (use a formula or a file)");
  for (const int label : labels)
    if (!values_of.contains(label))
      throw error_at(regions.place, "regions = " + shortened(inline_toml(regions)) + "; a value for region " +
                                        std::to_string(label) + " is missing (the mesh has: " + list + ")");
  for (const Member& m : regions.table().members) {
    if (!known.contains(m.key)) throw error_at(m.place, "the mesh has no region " + m.key + " (it has: " + list + ")");
  }
  std::vector<double> values;
  for (const int label : mesh.region) values.push_back(values_of[label]->number());
  return values;
}

std::vector<double> from_formula(const Value& value, const TetMesh& mesh) {
  const Expression formula(value.text());
  std::vector<double> values;
  try {
    for (int e = 0; e < mesh.element_count(); ++e) values.push_back(formula.at(element_center(mesh, e)));
  } catch (const InvalidInput& e) {
    throw error_at(value.place, e.what());
  }
  return values;
}

}  // namespace

std::vector<double> read_number_table(const fs::path& path, size_t columns, size_t rows, const std::string& row,
                                      const Place& place) {
  const std::string text = read_file(path);
  std::vector<double> values;
  size_t count = 0;
  int line_number = 0;
  bool may_be_header = true;
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line(text.data() + begin, end - begin);
    begin = end + 1;
    ++line_number;
    const std::string where = path.string() + ":" + std::to_string(line_number) + ": ";
    if (line.size() > kLongestLine) throw InvalidInput(where + "is too long for a line of a table");
    const std::vector<std::string_view> words = split_words(line);
    if (words.empty() || words[0].starts_with('#')) continue;
    double number = 0;
    const bool is_header = may_be_header && std::isalpha(static_cast<unsigned char>(words[0][0])) &&
                           !parse_finite(words[0], number) && words[0] != "nan" && words[0] != "inf";
    may_be_header = false;
    if (is_header) continue;
    if (words.size() != columns)
      throw InvalidInput(where + std::to_string(words.size()) + " numbers; " + std::to_string(columns) +
                         " are needed for each of the " + std::to_string(rows) + " lines");
    for (const std::string_view word : words) {
      if (!parse_finite(word, number)) throw InvalidInput(where + shown(word) + " is not a finite number");
      values.push_back(number);
    }
    if (++count > kMaxBeyond + rows) break;
  }
  if (count != rows)
    throw error_at(place, path.string() + " has " + (count > kMaxBeyond + rows ? "at least " : "") +
                              std::to_string(count) + " lines of numbers; one for " + row + " is needed, " +
                              std::to_string(rows) + " in all");
  return values;
}

std::vector<double> element_values(Table& table, const Key& key, const FieldScope& scope) {
  const TetMesh& mesh = scope.mesh;
  Value& value = *table.find(key.name);
  if (value.is_number()) return std::vector<double>(mesh.element_count(), value.number());
  std::vector<double> values;
  if (value.is_text()) {
    values = from_formula(value, mesh);
  } else if (const Value* regions = value.find("regions")) {
    values = from_regions(*regions, mesh, scope.groups);
  } else {
    values = from_file(value.table(), scope, scope.stem + "." + key.name);
  }
  for (int e = 0; e < mesh.element_count(); ++e)
    if (!key.range.contains(values[e]))
      throw error_at(value.place, key.name + " = " + number_text(values[e]) +
                                      (mesh.is_tet(e)        ? " in tet "
                                       : mesh.is_triangle(e) ? " in triangle "
                                                             : " in segment ") +
                                      std::to_string(scope.whole ? scope.whole->number_of_tet(e) : e) + " at " +
                                      point_text(element_center(mesh, e)) + "; must be " + key.range.text());
  return values;
}

}  // namespace aspic
