// The virtual bench: what a probe and cameras measure at the body of a scene, case by case, as a data set. The body is
// at rest in every case, on its own mesh; the data set has that mesh, or a coarser one.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "capture/data_set.h"
#include "capture/surface_projection.h"
#include "energy/held_tip.h"
#include "fit/next_poke.h"
#include "scene/material_file.h"
#include "scene/scene.h"

namespace aspic::viewer {

struct BenchOptions {
  int markers = 100;
  double noise = 0.01;  // standard deviation: of positions relative to the case's largest motion, of its force relative
                        // to the force
  uint64_t seed = 1;
  bool same_mesh = true;  // the fit has the mesh of the body: an inverse crime
};

class Bench {
 public:
  // Of the scene's one body, held where its pins hold it. Throws InvalidInput.
  Bench(const Scene& scene, const BenchOptions& options);
  ~Bench();

  const BenchOptions& options() const { return options_; }
  void set_options(const BenchOptions& options);  // other markers: refused by InvalidInput once there are cases

  // Presses a tip in, in equal parts up to that pose, and reads each part. Throws InvalidInput, with what was read
  // kept, when the body finds no rest or `stop` stops.
  void record(const Touch& touch, const TipPose& pose, int depths, const StopToken& stop);
  void forget(int c);  // a case
  void forget_all();

  const DataSet& data() const { return data_; }
  const std::vector<double>& depths() const { return depths_; }          // of each case [m]
  const std::vector<Vec3d>& marker_rest() const { return truth_rest_; }  // on the surface of the scene's body [m]
  const FittedMaterial& truth() const { return truth_; }
  bool is_same_mesh() const { return is_same_mesh_; }  // of the data and of the scene: an inverse crime
  const std::vector<std::string>& notes() const { return notes_; }

  std::vector<PokeSite> sites(double radius, int count) const;  // on the mesh of the scene
  // Values of each tet of the data's mesh for each tet of the scene's, by the order of its model.
  std::vector<double> on_scene(std::span<const double> of_data) const;
  std::vector<double> true_young() const;  // by the order of the data's mesh

 private:
  void set_up_mesh(const Scene& scene);
  void place_markers();
  LoadCase as_data(const LoadCase& load) const;  // with the tip where the surface of the data's mesh is
  void add(const LoadCase& load, const CasePrediction& found, double depth);

  BenchOptions options_;
  FittedMaterial truth_;                        // by the user's numbers
  std::vector<MaterialParameters> parameters_;  // of the truth, by the order of its mesh
  Experiment body_;                             // the truth, with the markers and no case
  Vec3d gravity_{};
  DataSet data_;
  bool is_same_mesh_ = false;
  std::vector<std::string> notes_;
  std::unique_ptr<SurfaceProjection> on_truth_, on_data_;
  std::vector<Vec3d> marker_rest_, truth_rest_;  // on the surfaces of data and truth [m]
  std::vector<double> depths_;
  std::vector<int> data_tet_;  // in which each tet of the scene lies
  uint64_t recorded_ = 0;      // cases so far: each has noise of its own
  int groups_ = 0;
};

}  // namespace aspic::viewer
