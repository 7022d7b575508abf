#include "ranks/rank_frames.h"

#include <algorithm>
#include <string>

#include "io/vtu.h"
#include "ranks/exchange.h"
#include "results/run_directory_frame.h"

namespace aspic::distributed {
namespace {

// The local vertices and tets of a piece, in the user's order.
struct Piece {
  std::vector<int> vertices, tets;
  std::vector<double> points;
  std::vector<Tet> corners;  // indices of `vertices`
};

Piece piece_of(const Simulation& local, const MeshShare& share) {
  Piece piece;
  for (const MeshShare::Body& body : share.bodies)
    for (int t = body.first_tet; t < body.first_tet + body.counted; ++t) piece.tets.push_back(t);
  std::sort(piece.tets.begin(), piece.tets.end(), [&](int a, int b) { return share.user_tet[a] < share.user_tet[b]; });
  std::vector<int> place(share.local_vertices(), -1);
  std::fill(place.begin(), place.begin() + share.own(), 0);
  const std::vector<Tet>& tets = local.model().mesh.tets;
  for (const int t : piece.tets)
    for (const int v : tets[t]) place[v] = 0;
  for (int v = 0; v < share.local_vertices(); ++v)
    if (place[v] == 0) piece.vertices.push_back(v);
  std::sort(piece.vertices.begin(), piece.vertices.end(),
            [&](int a, int b) { return share.user_vertex[a] < share.user_vertex[b]; });
  const std::vector<double>& q = local.state().q;
  for (size_t i = 0; i < piece.vertices.size(); ++i) {
    const int v = piece.vertices[i];
    place[v] = static_cast<int>(i);
    for (int r = 0; r < 3; ++r) piece.points.push_back(q[3 * static_cast<size_t>(v) + r]);
  }
  for (const int t : piece.tets)
    piece.corners.push_back({place[tets[t][0]], place[tets[t][1]], place[tets[t][2]], place[tets[t][3]]});
  return piece;
}

void select(const std::vector<int>& kept, Field& field) {
  std::vector<double> values;
  const auto components = static_cast<size_t>(field.components);
  values.reserve(components * kept.size());
  for (const int i : kept)
    for (size_t c = 0; c < components; ++c) values.push_back(field.values[components * static_cast<size_t>(i) + c]);
  field.values = std::move(values);
}

Field numbers(const char* name, const std::vector<int>& kept, const std::vector<int>& user) {
  Field field{name, 1, {}, FieldType::int32};
  for (const int i : kept) field.values.push_back(user[i]);
  return field;
}

}  // namespace

void write_pieces(const RunLayout& layout, const DistributedSimulation& simulation, const StepReport* report,
                  const FrameOptions& options) {
  const MeshShare& share = simulation.share();
  const Piece piece = piece_of(simulation.local(), share);
  VtuFields fields = frame_fields(simulation.local(), report, {.double_precision = options.double_precision});
  for (Field& field : fields.point_fields) select(piece.vertices, field);
  for (Field& field : fields.cell_fields) select(piece.tets, field);
  const bool is_whole = share.ranks() == 1;
  if (!is_whole) {
    fields.point_fields.push_back(numbers("vertex", piece.vertices, share.user_vertex));
    fields.cell_fields.push_back(numbers("tet", piece.tets, share.user_tet));
  }
  const std::string file =
      is_whole ? RunLayout::frame_file(options.frame) : RunLayout::piece_file(options.frame, share.rank);
  write_vtu((layout.root() / file).string(), piece.points, piece.corners, fields);
  wait_for_all();  // an index has all of its pieces
  if (is_whole || share.rank > 0) return;
  std::vector<std::string> pieces;
  for (int rank = 0; rank < share.ranks(); ++rank)
    pieces.push_back(std::filesystem::path(RunLayout::piece_file(options.frame, rank)).filename().string());
  write_pvtu((layout.root() / RunLayout::pieces_file(options.frame)).string(), pieces, fields);
}

}  // namespace aspic::distributed
