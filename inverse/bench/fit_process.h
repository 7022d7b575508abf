// `aspic fit` of a data set, as a process of its own.
#pragma once
#include <filesystem>
#include <string>

#include "io/child_process.h"
#include "scene/material_file.h"
#include "viewer/arguments.h"

namespace aspic::bench {

class FitProcess {
 public:
  // Fits Young's modulus of every tet with the law of the true material and the means of its other quantities. Throws
  // InvalidInput if the program cannot be started.
  FitProcess(const std::filesystem::path& data, const FittedMaterial& truth);

  bool is_running() { return process_.is_running(); }
  void stop() { process_.terminate(); }  // its current material becomes the result
  viewer::Json state();                  // {"running", "folder", "line", "has_report"}
  const std::filesystem::path& report() const { return report_; }

 private:
  std::string last_line();  // of its output

  std::filesystem::path folder_, report_, output_;
  ChildProcess process_;
};

}  // namespace aspic::bench
