// The virtual bench: simulates the measurements of a probe and cameras on the body of a scene as a data set of load
// cases. The body is at rest in each case. The data set has the mesh of the body or a coarser one.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "capture/data_set.h"
#include "capture/surface_projection.h"
#include "energy/held_indenter.h"
#include "fit/indentation_sites.h"
#include "scene/material_file.h"
#include "scene/scene.h"

namespace aspic::viewer {

struct BenchOptions {
  int markers = 100;
  double noise = 0.01;  // standard deviation of the positions relative to the largest displacement of the case, and of
                        // the force relative to the force
  uint64_t seed = 1;
  bool same_mesh = true;  // the fit uses the mesh of the body: an inverse crime
};

class Bench {
 public:
  // Requires a scene with one body that its pins hold. Throws InvalidInput otherwise.
  Bench(const Scene& scene, const BenchOptions& options);
  ~Bench();

  const BenchOptions& options() const { return options_; }
  void set_options(const BenchOptions& options);  // throws InvalidInput: other markers after the first case

  // Moves an indenter to that pose in `depths` equal increments and measures after each one. Throws InvalidInput if the
  // body finds no equilibrium or `stop` stops. The earlier measurements remain.
  void record(const FirstContact& touch, const IndenterPose& pose, int depths, const StopToken& stop);
  void forget(int c);  // drops case c
  void forget_all();

  const DataSet& data() const { return data_; }
  const std::vector<double>& depths() const { return depths_; }          // indentation of each case [m]
  const std::vector<Vec3d>& marker_rest() const { return truth_rest_; }  // positions on the surface at rest [m]
  const FittedMaterial& truth() const { return truth_; }
  bool is_same_mesh() const { return is_same_mesh_; }  // data set and scene share a mesh: an inverse crime
  const std::vector<std::string>& notes() const { return notes_; }

  std::vector<IndentationSite> sites(double radius, int count) const;  // points on the mesh of the scene
  // Maps values per tet of the data set's mesh to the tets of the scene, in the order of its model.
  std::vector<double> on_scene(std::span<const double> of_data) const;
  std::vector<double> true_young() const;  // E per tet in the order of the data set's mesh [Pa]

 private:
  void set_up_mesh(const Scene& scene);
  void place_markers();
  LoadCase as_data(const LoadCase& load) const;  // moves the indenter to the surface of the data set's mesh
  void add(const LoadCase& load, const CasePrediction& found, double depth);

  BenchOptions options_;
  FittedMaterial truth_;                        // in the user's numbering
  std::vector<MaterialParameters> parameters_;  // true material in the order of its mesh
  Experiment body_;                             // the true body with the markers and without cases
  Vec3d gravity_{};
  DataSet data_;
  bool is_same_mesh_ = false;
  std::vector<std::string> notes_;
  std::unique_ptr<SurfaceProjection> on_truth_, on_data_;
  std::vector<Vec3d> marker_rest_, truth_rest_;  // positions on the surfaces of data set and true body [m]
  std::vector<double> depths_;
  std::vector<int> data_tet_;  // tet of the data set that contains each tet of the scene
  uint64_t recorded_ = 0;      // number of cases so far; seeds the noise of each case
  int groups_ = 0;
};

}  // namespace aspic::viewer
