#include "aspic/lecture/sheet.h"

#include <algorithm>
#include <system_error>

#include "base/error.h"
#include "io/atomic_file.h"
#include "io/external_program.h"

namespace aspic::cli::lecture {
namespace {

bool has_gnuplot() {
  static const bool found = [] {
    try {
      find_program("gnuplot", {}, "");
      return true;
    } catch (const InvalidInput&) {
      return false;
    }
  }();
  return found;
}

}  // namespace

std::string to_string(Relation relation) {
  constexpr const char* kTexts[] = {"<=", ">=", "=", ""};
  return kTexts[static_cast<size_t>(relation)];
}

bool Measure::holds() const {
  if (relation == Relation::at_most) return value <= bound;
  if (relation == Relation::at_least) return value >= bound;
  return relation == Relation::shown || value == bound;
}

Sheet::Sheet(std::filesystem::path folder, Pictures pictures) : folder_(std::move(folder)), pictures_(pictures) {
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error) throw InvalidInput(folder_.string() + ": cannot be created: " + error.message());
}

void Sheet::at_most(std::string what, double value, double bound, std::string unit, std::string reason) {
  measures_.push_back({std::move(what), value, std::move(unit), Relation::at_most, bound, std::move(reason)});
}
void Sheet::at_least(std::string what, double value, double bound, std::string unit, std::string reason) {
  measures_.push_back({std::move(what), value, std::move(unit), Relation::at_least, bound, std::move(reason)});
}
void Sheet::equals(std::string what, double value, double expected, std::string unit, std::string reason) {
  measures_.push_back({std::move(what), value, std::move(unit), Relation::equals, expected, std::move(reason)});
}
void Sheet::show(std::string what, double value, std::string unit, std::string meaning) {
  measures_.push_back({std::move(what), value, std::move(unit), Relation::shown, 0, std::move(meaning)});
}

CsvFile Sheet::table(const std::string& name, const std::vector<std::string>& columns) const {
  return CsvFile::create(folder_ / name, columns);
}

void Sheet::keep(const Scene& scene) const {
  write_file(folder_ / (scene.name + ".toml"), scene.resolved);
  write_inputs(scene, folder_);
}

void Sheet::draw_by(const std::string& name, const std::string& caption,
                    const std::function<void(const std::filesystem::path&)>& write) {
  if (!can_draw()) return;
  write(folder_ / name);
  figures_.push_back({folder_ / name, caption});
}

void Sheet::draw(const std::string& name, const std::string& caption, MeshPicture picture) {
  if (pictures_ == Pictures::none) return;
  meshes_.push_back({{folder_ / name, caption}, std::move(picture)});
}

bool Sheet::draw_meshes(const std::vector<Sheet*>& sheets, const StopToken& stop) {
  std::vector<MeshDrawing> drawings;
  for (const Sheet* sheet : sheets)
    for (const MeshFigure& mesh : sheet->meshes_) drawings.push_back({mesh.figure.picture, mesh.picture});
  std::string missing;
  try {
    if (!drawings.empty() && !cli::draw(drawings, stop)) return false;
  } catch (const InvalidInput& error) {
    missing = error.what();
  }
  for (Sheet* sheet : sheets) {
    if (!sheet->meshes_.empty() && !missing.empty()) sheet->remark("no pictures of meshes: " + missing);
    for (MeshFigure& mesh : sheet->meshes_)
      if (missing.empty()) sheet->figures_.push_back(std::move(mesh.figure));
    sheet->meshes_.clear();
  }
  return true;
}

bool Sheet::passes() const {
  const auto is_judged = [](const Measure& m) { return m.relation != Relation::shown; };
  return std::any_of(measures_.begin(), measures_.end(), is_judged) &&
         std::all_of(measures_.begin(), measures_.end(), [](const Measure& m) { return m.holds(); });
}

bool Sheet::can_draw() {
  if (pictures_ == Pictures::none) return false;
  if (!has_gnuplot() && !reported_missing_) remark("no charts: gnuplot is not installed (Debian package gnuplot-nox)");
  reported_missing_ = !has_gnuplot();
  return has_gnuplot();
}

}  // namespace aspic::cli::lecture
