// Finds the stencils of the barrier at given positions. The result depends on the positions alone; candidates of
// earlier positions only save time.
#pragma once
#include <array>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "contact/contact_candidates.h"
#include "contact/contact_meter.h"
#include "contact/contact_stencil.h"

namespace aspic {

using ContactStencils = std::vector<ContactStencil>;

class StencilSearch {
 public:
  StencilSearch(const ContactMesh& mesh, const ContactLaws& laws);  // both must outlive this

  // Returns the stencils with a gap below their reach, in an order that depends on the positions alone. Thread-safe.
  // Throws std::length_error if there are too many close pairs for the memory.
  std::shared_ptr<const ContactStencils> at(std::span<const Vec3d> points) const;
  // Returns candidates for all positions on the lines from `points` to `points` + `d`, or nothing if there are too
  // many.
  std::optional<PathCandidates> along(PairScope scope, std::span<const Vec3d> points, std::span<const Vec3d> d) const;

  ContactMeter& meter() const { return meter_; }
  int self_touching_point() const;  // a point whose distance to its own body at rest is zero; -1: none

 private:
  using Candidates = std::array<PathCandidates, 2>;  // between parts and within them
  ContactStencils stencils(const Candidates& candidates, std::span<const Vec3d> points) const;
  void add_point(const PathCandidates& candidates, std::span<const Vec3d> points, int p, ContactStencils& found) const;
  void add_planes(std::span<const Vec3d> points, int p, ContactStencils& found) const;
  void add_edges(const EdgePair& pair, std::span<const Vec3d> points, ContactStencils& found) const;

  const ContactMesh& mesh_;
  const ContactLaws& laws_;
  std::vector<double> cap_;  // upper bound of the reach of each point to its own body: half its distance at rest [m]
  mutable ContactMeter meter_;
  mutable std::mutex mutex_;
  mutable CandidateSearch within_, between_;
  mutable std::vector<Vec3d> points_;  // positions of stencils_
  mutable std::shared_ptr<const ContactStencils> stencils_;
};

}  // namespace aspic
