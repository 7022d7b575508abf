#include "data/settings.h"

#include <algorithm>

#include "base/error.h"
#include "data/capture_schema.h"
#include "data/units.h"
#include "scene/toml_reader.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;

fs::path settings_file(const fs::path& path) {
  std::error_code error;
  if (!fs::is_directory(path, error)) {
    if (!fs::exists(path, error)) throw InvalidInput(path.string() + ": does not exist; a data set is a folder");
    return path;
  }
  const fs::path file = path / "capture.toml";
  if (!fs::exists(file, error))
    throw InvalidInput(path.string() +
                       ": has no capture.toml, which describes a data set (inverse/docs/capture_format.md)");
  return file;
}

fs::path folder_of(const fs::path& file) { return file.has_parent_path() ? file.parent_path() : fs::path("."); }

}  // namespace

CaptureSettings::CaptureSettings(const fs::path& path)
    : file_(settings_file(path)), folder_(folder_of(file_)), files_(folder_, false) {
  document_ = read_toml(read_toml_text(file_), file_.string());
  check_and_complete(document_, file_.string(), capture_schema(), "capture");
}

bool CaptureSettings::is_given(std::string_view key) const { return (*this)[key].place.line > 0; }

fs::path CaptureSettings::file(std::string_view key) const {
  Value name = (*this)[key];
  if (!is_given(key)) name.place = {std::make_shared<const std::string>(file_.string()), 1, 1};
  return files_.find(name);
}

double CaptureSettings::unit(const std::string& quantity) const {
  const Value& units = (*this)["units"];
  if (const Value* name = units.find(quantity)) return unit_in_si(quantity, name->text());
  if (quantity == "mesh") return unit("length");
  if (quantity == "torque") return unit("force") * unit("length");
  return 1;
}

ColumnNames CaptureSettings::columns(const std::string& table_name) const {
  ColumnNames names{table_name == "markers"  ? marker_columns()
                    : table_name == "cases"  ? case_columns()
                    : table_name == "forces" ? series_columns()
                                             : position_columns(),
                    {}};
  const Value& columns = (*this)["columns"];
  const auto is_known = [&](const std::string& name) {
    return std::find(names.known.begin(), names.known.end(), name) != names.known.end();
  };
  for (const Member& m : columns.table().members)
    if (m.value.is_text() && is_known(m.key)) names.as_written[m.key] = m.value.text();
  if (const Value* own = columns.find(table_name))
    for (const Member& m : own->table().members) names.as_written[m.key] = m.value.text();
  return names;
}

}  // namespace aspic
