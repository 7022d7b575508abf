// Readers of the package of inverse problems: measurements and the journal of a fit.
#include <cmath>
#include <filesystem>
#include <string>

#include "data/data_set.h"
#include "data/motion_table.h"
#include "mesh/generators.h"
#include "pipeline/journal.h"
#include "run_files.h"
#include "several_files.h"
#include "targets.h"

namespace aspic::fuzz {
namespace {

namespace fs = std::filesystem;

// Makes the calls of a fit with the identity as its model.
class Identity : public LeastSquares {
 public:
  int parameter_count() const override { return 2; }
  int residual_count() const override { return 2; }
  bool evaluate(std::span<const double> p, std::span<double> r) override { return copy(p, r), true; }
  bool linearize() override { return true; }
  void multiply(std::span<const double> dp, std::span<double> dr) override { copy(dp, dr); }
  void multiply_transposed(std::span<const double> w, std::span<double> pbar) override { copy(w, pbar); }

 private:
  static void copy(std::span<const double> from, std::span<double> to) {
    std::copy(from.begin(), from.end(), to.begin());
  }
};

}  // namespace

void data_set(std::string_view bytes) {
  const fs::path folder = folder_of_process();
  const Files files(folder, bytes,
                    {"capture.toml", "markers.csv", "cases.csv", "positions.csv", "rest.msh", "patch.csv"});
  const DataSet data = read_data_set(folder);
  for (const DataFinding& finding : diagnose(data)) require_printable({finding.where, finding.what, finding.remedy});
  require_printable(data.notes);
  for (const LoadCase& measured : data.experiment.cases) require_printable({measured.name});
  for (const SurfacePoint& marker : data.experiment.markers)
    for (const int v : marker.vertices)
      require(v >= 0 && v < data.experiment.mesh.vertex_count(), "markers refer to vertices of the mesh");
}

void motion_table(std::string_view bytes) {
  const TetMesh mesh = make_box({{0, 0, 0}}, {{1, 1, 1}}, {1, 1, 1});
  const fs::path path = folder_of_process() / "positions.csv";
  put_file(path, bytes);
  std::vector<std::string> notes;
  const MotionData data = attach_markers(read_motion_table(path), mesh, at_rest(mesh), 0.01, notes);
  require_printable(notes);
  for (const MotionSample& sample : data.samples) require(sample.time > 0 && sample.sigma > 0, "samples are valid");
}

void journal(std::string_view bytes) {
  const fs::path stem = folder_of_process() / "fit";
  const Files files(folder_of_process(), bytes, {"fit.journal", "fit.state"});
  make_checkpoint_right(folder_of_process() / "fit.state", "fuzz");
  Identity model;
  std::vector<double> state = {1, 2}, p = {0.5, 1}, r(2);
  const ModelState keeps{[&] { return state; }, [&](std::span<const double> s) { state.assign(s.begin(), s.end()); }};
  Journal log(model, keeps, stem, "fuzz", JournalStart::resume);
  for (int i = 0; i < 3; ++i) {
    log.evaluate(p, r);
    log.linearize();
    log.multiply(p, r);
    log.multiply_transposed(r, p);
  }
  Journal::remove(stem);
}

}  // namespace aspic::fuzz
