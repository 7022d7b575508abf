// Which files a run writes, and nothing else: where they are, which may be removed.
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
  std::filesystem::path checkpoint() const { return root_ / "checkpoint.bin"; }
  std::filesystem::path index() const { return root_ / "run.pvd"; }
  std::filesystem::path usd() const { return root_ / "run.usda"; }
  std::filesystem::path report() const { return root_ / "report.html"; }
  std::filesystem::path frames() const { return root_ / "frames"; }
  std::filesystem::path skins() const { return root_ / "skins"; }
  std::filesystem::path trace(int first_step) const;  // "trace", or "trace_after_12" of a run resumed there

  static std::string frame_file(int frame);  // "frames/body_000123.vtu", relative to the root
  std::filesystem::path skin_frame(const std::string& skin, int frame, const std::string& extension) const;
  std::filesystem::path skin_rest(const std::string& skin) const { return skins() / ("skin_" + skin + ".obj"); }
  std::filesystem::path skin_cache(const std::string& skin) const { return skins() / ("skin_" + skin + ".pc2"); }

  bool holds_run() const;        // a steps.csv with the head that runs write
  bool is_barely_begun() const;  // nothing but what a run that was killed at once had begun to write
  // Throws InvalidInput where a file or folder that a run writes is a link: its target is none of the run's.
  void refuse_links() const;
  // Every file of the run, its inputs included, except those in `needed`.
  void remove_run(const std::vector<std::filesystem::path>& needed) const;
  void remove_frames_from(int first) const;  // of bodies and skins
  void remove_unfinished() const;            // what a killed run was about to write

 private:
  std::filesystem::path root_;
};

// Names of bodies as parts of file names: letters, digits, - and _; no two alike, whatever their case.
std::vector<std::string> file_names(const std::vector<std::string>& names);

}  // namespace aspic
