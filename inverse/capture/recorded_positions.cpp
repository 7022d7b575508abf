#include "capture/recorded_positions.h"

#include <cmath>

#include "base/error.h"
#include "capture/rigid_motion.h"

namespace aspic {
namespace {

constexpr double kAlongAxis = 0.9999;  // cosine
constexpr double kUnknown = 1e3;  // standard deviation of a coordinate that was not measured, over the size of the body

bool is_in_pixels(const Recording& recording, const CaptureSettings& settings) {
  return recording.is_planar && !recording.unit && !settings["units"].find("recording");
}

// The settings override the file, which overrides the unit of the tables. The registration scales pixels to m.
double unit_of(const Recording& recording, const CaptureSettings& settings) {
  if (is_in_pixels(recording, settings)) return 1;
  if (settings["units"].find("recording")) return settings.unit("recording");
  return recording.unit.value_or(settings.unit("length"));
}

}  // namespace

RecordedPositions::RecordedPositions(Recording recording, const CaptureSettings& settings, double size,
                                     std::vector<std::string>& notes)
    : recording_(std::move(recording)),
      is_in_pixels_(aspic::is_in_pixels(recording_, settings)),
      unit_(unit_of(recording_, settings)),
      size_(size) {
  notes.insert(notes.end(), recording_.notes.begin(), recording_.notes.end());
  if (const Value* frame = settings.find("rest_frame")) {
    try {
      rest_ = frame_numbered(recording_, frame->integer());
    } catch (const InvalidInput& error) {
      throw error_at(frame->place, "rest_frame: " + std::string(error.what()));
    }
  }
  if (recording_.is_planar) unmeasured_ = 2;
  if (recording_.is_planar)
    notes.push_back(recording_.file + ": has two coordinates per point" +
                    (is_in_pixels_ ? ", in pixels (units.recording states another unit)" : "") +
                    "; z was not measured and counts as unknown");
  for (size_t i = 0; i < recording_.names.size(); ++i) point_of_[recording_.names[i]] = static_cast<int>(i);
}

std::optional<Vec3d> RecordedPositions::rest(const std::string& name) const {
  const auto found = point_of_.find(name);
  if (found == point_of_.end()) return std::nullopt;
  const Vec3d& p = recording_.frames[rest_].positions[found->second];
  return is_seen(p) ? std::optional(on_mesh(p)) : std::nullopt;
}

std::vector<int> RecordedPositions::points(const std::vector<std::string>& names) const {
  std::vector<int> points;
  bool is_any_known = false;
  for (const std::string& name : names) {
    const auto found = point_of_.find(name);
    points.push_back(found == point_of_.end() ? -1 : found->second);
    is_any_known |= points.back() >= 0;
  }
  if (!is_any_known && !names.empty())
    throw InvalidInput(recording_.file + ": has no point '" + names[0] + "', nor any other marker of the table" +
                       suggestion(names[0], recording_.names));
  return points;
}

const RecordedFrame& RecordedPositions::frame(const CaseFrame& wanted) const {
  if (!wanted.number && !wanted.time)
    throw InvalidInput("frame and time are blank; one of them selects the frame of " + recording_.file);
  return recording_
      .frames[wanted.number ? frame_numbered(recording_, *wanted.number) : frame_at(recording_, *wanted.time)];
}

Vec3d RecordedPositions::sigma(double stated) const {
  Vec3d sigma = {{stated, stated, stated}};
  if (unmeasured_ >= 0) sigma[unmeasured_] = kUnknown * size_;
  return sigma;
}

void RecordedPositions::set_registration(const AffineMap& to_mesh) {
  to_mesh_ = to_mesh;
  if (!recording_.is_planar) return;
  const Mat3d R = rotation_of(to_mesh);
  unmeasured_ = -1;
  for (int axis = 0; axis < 3; ++axis)
    if (std::abs(R(axis, 2)) > kAlongAxis) unmeasured_ = axis;
  if (unmeasured_ < 0)
    throw InvalidInput(
        recording_.file +
        ": the registration turns the plane of the image out of the planes of the coordinates; turn the mesh "
        "so that the image is parallel to one of them");
}

std::optional<double> RecordedPositions::time_of(const CaseFrame& wanted) const {
  if (wanted.time || !wanted.number || !recording_.has_times) return wanted.time;
  return recording_.frames[frame_numbered(recording_, *wanted.number)].time;
}

double RecordedPositions::interval() const {
  const std::vector<RecordedFrame>& f = recording_.frames;
  return recording_.has_times && f.size() > 1 ? (f.back().time - f.front().time) / static_cast<double>(f.size() - 1)
                                              : 0;
}

}  // namespace aspic
