// Two numberings of one mesh: the user's, for files and selections, and the storage order, which keeps spatial
// neighbors close in memory.
#pragma once
#include <span>
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

// Permutation of the vertices or the elements; the identity by default.
class Renumbering {
 public:
  Renumbering() = default;
  explicit Renumbering(std::vector<int> user_of_stored);  // user's index of each stored element

  // Elements beyond those of the permutation keep their index.
  int to_user(int stored) const { return is_beyond(stored) ? stored : user_[stored]; }
  int from_user(int user) const { return is_beyond(user) ? user : stored_[user]; }
  std::vector<int> to_user(std::vector<int> stored) const;  // user's indices of a set, ascending

  // Reorders values of all elements, `components` values per element.
  std::vector<double> to_user(std::span<const double> stored, int components = 1) const;
  std::vector<double> from_user(std::span<const double> user, int components = 1) const;

  bool is_identity() const { return user_.empty(); }  // both orders are equal
  // Appends a permutation `part` of `more` elements to this one, which has `count` elements.
  void append(int count, const Renumbering& part, int more);

 private:
  bool is_beyond(int element) const { return static_cast<size_t>(element) >= user_.size(); }

  std::vector<int> user_, stored_;  // both empty: identity
};

// Numberings of the vertices and the tets of one mesh.
struct Numbering {
  Renumbering vertex, tet;
};

// Returns an order along a Hilbert curve. `mesh` is in the user's order.
Numbering locality_numbering(const TetMesh& mesh);

// Reorder a mesh. The corners of each tet and the elements of sheets and rods keep their order.
TetMesh from_user(const Numbering& numbering, const TetMesh& user);
TetMesh to_user(const Numbering& numbering, const TetMesh& stored);

}  // namespace aspic
