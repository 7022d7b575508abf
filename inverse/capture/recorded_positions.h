// Positions of markers from a recording instead of a table.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "capture/data_set.h"
#include "capture/settings.h"
#include "recording/recording.h"
#include "scene/placement.h"

namespace aspic {

class RecordedPositions {
 public:
  // Uses the unit of the recording, otherwise that of the data set. Throws InvalidInput if there is no rest_frame.
  // `size`: of the body [m].
  RecordedPositions(Recording recording, const CaptureSettings& settings, double size, std::vector<std::string>& notes);

  const std::vector<std::string>& names() const { return recording_.names; }
  std::optional<Vec3d> rest(const std::string& name) const;  // [m]; empty: unknown, or not seen
  const std::string& where_at_rest() const { return recording_.frames[rest_].where; }
  // Index of the point of each name; -1 if there is none. Throws InvalidInput if there are none at all.
  std::vector<int> points(const std::vector<std::string>& names) const;
  // Throws InvalidInput if a case names no frame, or one that the recording does not have.
  const RecordedFrame& frame(const CaseFrame& wanted) const;

  std::optional<double> time_of(const CaseFrame& wanted) const;  // [s]
  double interval() const;                                       // mean time between frames [s]; 0 without times
  double unit() const { return unit_; }                          // [m]; 1 for pixels
  bool is_in_pixels() const { return is_in_pixels_; }            // of an image, without a stated unit

  void set_registration(const AffineMap& to_mesh);  // throws InvalidInput if a plane of an image becomes oblique
  Vec3d on_mesh(const Vec3d& position) const { return to_mesh_(unit_ * position); }  // [m]
  // Standard deviations [m]; along an axis that was not measured, far larger than the body.
  Vec3d sigma(double stated) const;

 private:
  Recording recording_;
  AffineMap to_mesh_;
  int unmeasured_ = -1;  // axis of the mesh along which nothing was measured
  bool is_in_pixels_ = false;
  double unit_ = 1;  // [m]; 1 for pixels
  double size_ = 0;  // of the body [m]
  int rest_ = 0;     // index of the frame at rest
  std::map<std::string, int, std::less<>> point_of_;
};

}  // namespace aspic
