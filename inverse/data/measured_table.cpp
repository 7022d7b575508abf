#include "data/measured_table.h"

#include <cmath>

#include "base/error.h"
#include "base/printable.h"
#include "model/limits.h"

namespace aspic {
void ErrorList::add(const std::string& error) {
  if (lines_.size() < kMaxListed) {
    lines_.push_back(error);
  } else {
    ++further_;
  }
}

void ErrorList::finish() const {
  std::vector<std::string> lines = lines_;
  if (further_ > 0) lines.push_back("and " + std::to_string(further_) + " more");
  if (!lines.empty()) throw InvalidInput(lines);
}

MeasuredTable::MeasuredTable(const std::filesystem::path& path, const ColumnNames& names, ErrorList& errors,
                             std::vector<std::string>& notes)
    : csv_(path, CsvOrigin::foreign), errors_(errors) {
  const std::string file = path.filename().string();
  std::vector<bool> used(csv_.columns().size(), false);
  for (const std::string& name : names.known) {
    const auto renamed = names.as_written.find(name);
    const std::string& written = renamed == names.as_written.end() ? name : renamed->second;
    if (csv_.has(written)) {
      index_[name] = csv_.column(written);
      used[csv_.column(written)] = true;
    } else if (renamed != names.as_written.end()) {
      throw InvalidInput(file + ":1: has no column '" + written + "', which columns in capture.toml names for " + name +
                         suggestion(written, csv_.columns()));
    }
  }
  for (size_t c = 0; c < used.size(); ++c) {
    const std::string near = used[c] ? "" : nearest_name(csv_.columns()[c], names.known);
    if (!near.empty() && !has(near))
      notes.push_back(file + ": the column '" + csv_.columns()[c] + "' is not used (did you mean '" + near + "'?)");
  }
}

bool MeasuredTable::next() { return csv_.next(); }

void MeasuredTable::error(const std::string& text) { errors_.add(csv_.where() + ": " + text); }

const std::string& MeasuredTable::text(std::string_view column) const {
  static const std::string kBlank;
  const auto found = index_.find(column);
  return found == index_.end() ? kBlank : csv_.text(found->second);
}

bool MeasuredTable::is_blank(std::string_view column) const {
  const auto found = index_.find(column);
  return found == index_.end() || csv_.is_blank(found->second);
}

std::optional<double> MeasuredTable::number(std::string_view column, double unit) {
  const auto found = index_.find(column);
  if (found == index_.end() || csv_.is_blank(found->second)) return std::nullopt;
  const std::optional<double> value = csv_.try_number(found->second);
  if (value && std::isfinite(*value)) return *value * unit;
  error(csv_.columns()[found->second] + " = " + shown(csv_.text(found->second)) +
        " is not a finite number; correct it, or leave the cell blank if nothing was measured");
  return std::nullopt;
}

std::optional<int> MeasuredTable::integer(std::string_view column) {
  const std::optional<double> value = number(column);
  if (!value) return std::nullopt;
  if (*value == std::floor(*value) && std::abs(*value) < 2e9) return static_cast<int>(*value);
  error(std::string(column) + " = " + text(column) + " is not a whole number");
  return std::nullopt;
}

std::optional<double> MeasuredTable::positive(std::string_view column, double unit) {
  const std::optional<double> value = number(column, unit);
  if (!value || *value > 0) return value;
  error(std::string(column) + " = " + text(column) +
        "; a standard deviation must be > 0 (leave the cell blank for the default)");
  return std::nullopt;
}

std::optional<Vec3d> MeasuredTable::vector(const std::string& prefix, double unit, MissingColumn missing) {
  Vec3d v{};
  int given = 0, zeros = 0;
  std::string absent;
  for (int i = 0; i < 3; ++i) {
    const std::string name = prefix + "xyz"[i];
    const std::optional<double> value = number(name, unit);
    if (!value && !is_blank(name)) return std::nullopt;  // the error is listed
    if (value) v[i] = *value, ++given;
    if (has(name)) continue;
    if (missing == MissingColumn::zero) ++zeros;
    if (absent.empty()) absent = name;
  }
  if (given == 0) return std::nullopt;
  if (given + zeros == 3) return v;
  const std::string all = prefix + "x, " + prefix + "y, " + prefix + "z";
  if (!absent.empty() && missing == MissingColumn::refused)
    error(all + ": there is no column " + absent + "; add it, with 0 where this component is 0");
  else
    error(all + ": some are blank; give all three, or none");
  return std::nullopt;
}

int MeasuredTable::only_axis(const std::string& prefix) const {
  int axis = -1, count = 0;
  for (int i = 0; i < 3; ++i)
    if (has(prefix + "xyz"[i])) axis = i, ++count;
  return count == 1 ? axis : -1;
}

std::optional<Vec3d> MeasuredTable::sigma(const std::string& name, double unit) {
  const std::optional<double> all = positive(name, unit);
  Vec3d v{};
  int given = 0;
  for (int i = 0; i < 3; ++i) {
    const std::optional<double> value = positive(name + "_" + "xyz"[i], unit);
    if (value || all) v[i] = value.value_or(all.value_or(0)), ++given;
  }
  if (given == 3) return v;
  if (given > 0) error(name + "_x, _y, _z: some are blank; give all three, or " + name + " for all directions");
  return std::nullopt;
}

int MeasuredTable::index_of(const std::string& column, const std::map<std::string, int>& known) {
  const std::string& name = text(column);
  if (name.empty() && known.size() == 1) return 0;
  if (const auto found = known.find(name); found != known.end()) return found->second;
  if (name.empty()) {
    error("the column " + column + " is blank or missing");
    return -1;
  }
  std::vector<std::string> names;
  for (const auto& [n, i] : known)
    if (names.size() < 20) names.push_back(n);
  error(column + " = '" + name + "' is not in the table of " + column + "s" + suggestion(name, names));
  return -1;
}

}  // namespace aspic
