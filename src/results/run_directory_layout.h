// Paths of the files that a run writes, and their removal.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace aspic {

class RunLayout {
 public:
  explicit RunLayout(std::filesystem::path root) : root_(std::move(root)) {}

  const std::filesystem::path& root() const { return root_; }
  std::filesystem::path scene() const { return root_ / "scene.toml"; }
  std::filesystem::path steps() const { return root_ / "steps.csv"; }
  std::filesystem::path iterations() const { return root_ / "iterations.csv"; }
  std::filesystem::path timings() const { return root_ / "timings.csv"; }
  std::filesystem::path ranks() const { return root_ / "ranks.csv"; }  // of aspic-mpi
  std::filesystem::path checkpoint() const { return root_ / "checkpoint.bin"; }
  std::filesystem::path index() const { return root_ / "run.pvd"; }
  std::filesystem::path usd() const { return root_ / "run.usda"; }
  std::filesystem::path report() const { return root_ / "report.html"; }
  std::filesystem::path outcome() const { return root_ / "outcome.txt"; }  // of aspic run --continue
  std::filesystem::path frames() const { return root_ / "frames"; }
  std::filesystem::path skins() const { return root_ / "skins"; }
  std::filesystem::path obstacles() const { return root_ / "obstacles"; }
  std::filesystem::path trace(int first_step) const;  // "trace", or "trace_after_12" of a run resumed there

  static std::string frame_file(int frame);  // "frames/body_000123.vtu", relative to the root
  // Frames of several processes: an index, and the piece of each process.
  static std::string pieces_file(int frame);           // "frames/body_000123.pvtu"
  static std::string piece_file(int frame, int rank);  // "frames/piece_000123_00004.vtu"
  std::string file_of_frame(int frame) const;          // pieces_file() if it exists, else frame_file()
  static std::string obstacle_file() { return "obstacles/obstacles.vtu"; }
  static std::string obstacle_frame_file(int frame);  // "frames/obstacles_000123.vtu"
  std::filesystem::path obstacle_frame(const std::string& name, int frame) const;
  std::filesystem::path obstacle(const std::string& name) const { return obstacles() / ("obstacle_" + name + ".obj"); }
  std::filesystem::path skin_frame(const std::string& skin, int frame, const std::string& extension) const;
  std::filesystem::path skin_rest(const std::string& skin) const { return skins() / ("skin_" + skin + ".obj"); }
  std::filesystem::path skin_cache(const std::string& skin) const { return skins() / ("skin_" + skin + ".pc2"); }

  bool holds_run() const;        // contains a steps.csv with the header of runs
  bool is_barely_begun() const;  // contains at most an outcome and unfinished files of a run that was killed
  // Throws InvalidInput if a file or folder that a run writes is a link, whose target does not belong to the run.
  void refuse_links() const;
  // Removes every file of the run, also inputs, except those in `needed`.
  void remove_run(const std::vector<std::filesystem::path>& needed) const;
  void remove_frames_from(int first) const;  // of bodies, skins and obstacles
  void remove_unfinished() const;            // unfinished files of a killed run

 private:
  std::filesystem::path root_;
};

// Returns the names of bodies as parts of file names: letters, digits, - and _, unique regardless of case.
std::vector<std::string> file_names(const std::vector<std::string>& names);

}  // namespace aspic
