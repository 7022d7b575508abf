// The part of a model that one process holds, if several processes hold it together.
#pragma once
#include <span>
#include <utility>
#include <vector>

namespace aspic {

struct TetMesh;

// Communication of these processes. All of them must call the same functions in the same order.
class Ranks {
 public:
  virtual ~Ranks() = default;
  // Returns the values of all processes, one process after the other. All processes must pass equally many.
  virtual std::vector<double> gather(std::span<const double> own) const = 0;
  // Returns parts_of() for the vertices of this process, computed from the whole mesh. `mesh`: that of this process.
  // `modulus`: of its own vertices [Pa].
  virtual std::vector<int> parts(const TetMesh& mesh, std::span<const double> modulus) const = 0;
};

// Each vertex of the whole model belongs to one process. Those of this process come first in its model. Copies of
// vertices of other processes follow, such that its model contains every tet of its own vertices. Gradients and Hessian
// rows are complete for its own vertices only. Sums are added in the order of the processes, so they are
// bit-reproducible. By default, one process holds the whole model, and the functions return their arguments.
class Share {
 public:
  Share() = default;
  // `ranks` must outlive this. `first`: number of the first own vertex in the whole model.
  Share(const Ranks& ranks, int first, int own) : ranks_(&ranks), first_(first), own_(own) {}

  bool is_whole() const { return !ranks_; }
  const Ranks& ranks() const { return *ranks_; }                                // requires a part of a model
  int own(int vertices) const { return ranks_ ? own_ : vertices; }              // number of own vertices
  int in_whole(int vertex) const { return ranks_ ? first_ + vertex : vertex; }  // number of an own vertex

  double sum(double own) const;
  double max(double own) const;
  double min(double own) const;
  double norm(double own) const;  // square root of the sum of squares
  bool all(bool own) const { return min(own) > 0; }
  void sum(std::span<double> own) const;  // replaces each value by its sum over the processes
  // Replaces a value and its vertex by the largest value of all processes and its vertex in the whole model, which is
  // -1 if no process has one.
  void find_largest(double& value, int& vertex) const;

 private:
  const Ranks* ranks_ = nullptr;
  int first_ = 0, own_ = 0;
};

}  // namespace aspic
