#include "mesh/numbering.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "base/check.h"
#include "mesh/order.h"

namespace aspic {
namespace {

// Element i of the result is element source(i) of the input.
template <class Source>
std::vector<double> gathered(std::span<const double> values, int components, const Source& source) {
  const size_t width = static_cast<size_t>(components), count = values.size() / width;
  std::vector<double> result(values.size());
  for (size_t i = 0; i < count; ++i)
    std::copy_n(&values[width * static_cast<size_t>(source(static_cast<int>(i)))], width, &result[width * i]);
  return result;
}

// Vertex i of the result is vertex vertex_source(i) of the mesh; its vertex v becomes vertex_name(v).
template <class VertexSource, class VertexName, class TetSource>
TetMesh rearranged(const TetMesh& mesh, const VertexSource& vertex_source, const VertexName& vertex_name,
                   const TetSource& tet_source) {
  TetMesh result;
  result.rest.reserve(mesh.rest.size());
  for (int v = 0; v < mesh.vertex_count(); ++v) result.rest.push_back(mesh.rest[vertex_source(v)]);
  result.tets.reserve(mesh.tets.size());
  result.region.reserve(mesh.region.size());
  for (int t = 0; t < mesh.tet_count(); ++t) {
    const int source = tet_source(t);
    Tet corners = mesh.tets[source];
    for (int& corner : corners) corner = vertex_name(corner);
    result.tets.push_back(corners);
    if (!mesh.region.empty()) result.region.push_back(mesh.region[source]);
    if (mesh.mids.empty()) continue;
    MidNodes mids = mesh.mids[source];
    for (int& node : mids) node = node < 0 ? node : vertex_name(node);
    result.mids.push_back(mids);
  }
  for (Triangle triangle : mesh.sheet) {
    for (int& corner : triangle) corner = vertex_name(corner);
    result.sheet.push_back(triangle);
  }
  result.thickness = mesh.thickness;
  result.pattern = mesh.pattern;
  for (Segment segment : mesh.rods) {
    for (int& end : segment) end = vertex_name(end);
    result.rods.push_back(segment);
  }
  result.radius = mesh.radius;
  return result;
}

}  // namespace

Renumbering::Renumbering(std::vector<int> user_of_stored)
    : user_(std::move(user_of_stored)), stored_(user_.size(), -1) {
  for (size_t i = 0; i < user_.size(); ++i) {
    ASPIC_CHECK(0 <= user_[i] && user_[i] < static_cast<int>(user_.size()) && stored_[user_[i]] < 0);
    stored_[user_[i]] = static_cast<int>(i);
  }
}

std::vector<int> Renumbering::to_user(std::vector<int> stored) const {
  for (int& i : stored) i = to_user(i);
  std::sort(stored.begin(), stored.end());
  return stored;
}

std::vector<double> Renumbering::to_user(std::span<const double> stored, int components) const {
  return gathered(stored, components, [this](int user) { return from_user(user); });
}

std::vector<double> Renumbering::from_user(std::span<const double> user, int components) const {
  return gathered(user, components, [this](int stored) { return to_user(stored); });
}

void Renumbering::append(int count, const Renumbering& part, int more) {
  if (is_identity() && part.is_identity()) return;
  const auto extend = [&](std::vector<int>& ours, const std::vector<int>& theirs) {
    if (ours.empty()) {
      ours.resize(count);
      std::iota(ours.begin(), ours.end(), 0);
    }
    ASPIC_CHECK(static_cast<int>(ours.size()) == count && (theirs.empty() || static_cast<int>(theirs.size()) == more));
    ours.reserve(ours.size() + static_cast<size_t>(more));
    for (int i = 0; i < more; ++i) ours.push_back(count + (theirs.empty() ? i : theirs[i]));
  };
  extend(user_, part.user_);
  extend(stored_, part.stored_);
}

Numbering locality_numbering(const TetMesh& mesh) {
  return {Renumbering(hilbert_order(mesh.rest)), Renumbering(hilbert_order(centroids(mesh)))};
}

TetMesh from_user(const Numbering& numbering, const TetMesh& user) {
  const Renumbering &vertex = numbering.vertex, &tet = numbering.tet;
  return rearranged(
      user, [&](int v) { return vertex.to_user(v); }, [&](int v) { return vertex.from_user(v); },
      [&](int t) { return tet.to_user(t); });
}

TetMesh to_user(const Numbering& numbering, const TetMesh& stored) {
  const Renumbering &vertex = numbering.vertex, &tet = numbering.tet;
  return rearranged(
      stored, [&](int v) { return vertex.from_user(v); }, [&](int v) { return vertex.to_user(v); },
      [&](int t) { return tet.from_user(t); });
}

}  // namespace aspic
