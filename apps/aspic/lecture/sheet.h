// Measurements, files and pictures of one demonstration of the lecture.
#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "aspic/mesh_picture.h"
#include "aspic/plot.h"
#include "aspic/report_page.h"
#include "base/stop_token.h"
#include "io/csv.h"
#include "scene/scene.h"

namespace aspic::cli::lecture {

enum class Relation { at_most, at_least, equals, shown };  // shown: a value that is not judged

struct Measure {
  std::string what;
  double value = 0;
  std::string unit;
  Relation relation = Relation::shown;
  double bound = 0;
  std::string reason;  // source of the bound

  bool holds() const;  // false for NaN
};
std::string to_string(Relation relation);

enum class Pictures { drawn, none };

class Sheet {
 public:
  // Writes to `folder`, which is created. Throws InvalidInput.
  explicit Sheet(std::filesystem::path folder, Pictures pictures = Pictures::drawn);

  void at_most(std::string what, double value, double bound, std::string unit, std::string reason);
  void at_least(std::string what, double value, double bound, std::string unit, std::string reason);
  void equals(std::string what, double value, double expected, std::string unit, std::string reason);  // counts
  void show(std::string what, double value, std::string unit, std::string meaning = "");
  void remark(std::string text) { remarks_.push_back(std::move(text)); }

  CsvFile table(const std::string& name, const std::vector<std::string>& columns) const;
  void keep(const Scene& scene) const;  // writes NAME.toml next to the data, ready to run
  template <class Picture>
  void draw(const std::string& name, const std::string& caption, const Picture& picture) {
    draw_by(name, caption, [&](const std::filesystem::path& path) { cli::draw(path, picture); });
  }
  void draw(const std::string& name, const std::string& caption, MeshPicture picture);  // drawn by draw_meshes()
  void draw_by(const std::string& name, const std::string& caption,
               const std::function<void(const std::filesystem::path&)>& write);

  const std::filesystem::path& folder() const { return folder_; }
  const std::vector<Measure>& measures() const { return measures_; }
  const std::vector<std::string>& remarks() const { return remarks_; }
  const std::vector<Figure>& figures() const { return figures_; }
  bool passes() const;  // at least one value is judged, and all pass

  // Draws the meshes of all sheets together; failures become remarks. Returns false if stopped.
  static bool draw_meshes(const std::vector<Sheet*>& sheets, const StopToken& stop);

 private:
  struct MeshFigure {
    Figure figure;
    MeshPicture picture;
  };

  bool can_draw();  // reports once if gnuplot is missing

  std::filesystem::path folder_;
  Pictures pictures_;
  std::vector<Measure> measures_;
  std::vector<std::string> remarks_;
  std::vector<Figure> figures_;
  std::vector<MeshFigure> meshes_;  // pending pictures
  bool reported_missing_ = false;
};

}  // namespace aspic::cli::lecture
