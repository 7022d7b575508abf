// Sum over tets of volume * psi(F) for one energy density M, as a term of V. Base is Energy or an interface derived
// from it; Batch is the element. Included only where it is instantiated.
#pragma once
#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/huge_pages.h"
#include "base/parallel.h"
#include "energy/coloring.h"
#include "energy/energy.h"
#include "energy/law_hessian.h"
#include "energy/tet_batch.h"
#include "material/law_eigen.h"
#include "material/material.h"
#include "math/definite.h"
#include "mesh/order.h"

namespace aspic {

template <class M, class Base, class Batch = TetBatch>
class TetTerm : public Base {
 public:
  template <class T>
  using Params = typename M::template Params<T>;
  using Context = Energy::Context;

  // Uses tets [first, first + parameters.size()) of the mesh.
  TetTerm(std::string name, const TetMesh& mesh, int first, std::span<const Params<double>> parameters, M material = {})
      : material_(std::move(material)),
        batches_((parameters.size() + kPackWidth - 1) / kPackWidth),
        params_(kPoints * batches_.size()),
        name_(std::move(name)),
        tets_per_group_(group_size(parameters.size())) {
    const std::vector<int> order = locality_order(mesh, first, parameters.size());
    parallel_for(group_count(), [&](int group) {
      const size_t begin = group * tets_per_group_;
      const auto tets = std::span(order).subspan(begin, std::min(tets_per_group_, order.size() - begin));
      fill_group(group, mesh, tets, [&](int tet) { return parameters[tet - first]; });
    });
    color(mesh.vertex_count());
  }

  std::string_view name() const override { return name_; }

  double value(Positions x, const Context& context) const override {
    const std::vector<Params<Pack>>& p = params(context);
    const double V = reduce([&](int i) { return sum(batches_[i].volume * density_sum(i, F(i, x), p)); },
                            [](double a, double b) { return a + b; }, 0.0);
    return std::isnan(V) ? INFINITY : V;  // zero-volume lanes with infinite density
  }

  void add_gradient(Positions x, const Context& context, double scale, std::span<double> g) const override {
    const std::vector<Params<Pack>>& p = params(context);
    for_each_batch([&](int i) {
      if constexpr (kPoints == 1) {
        batches_[i].scatter_gradient(material_.pk1(F(i, x), p[i]), Pack(scale) * batches_[i].volume, g);
      } else {
        const Points F_i = F(i, x);
        if (is_zero(F_i)) return;
        batches_[i].scatter_gradient(at_points([&](int q) { return material_.pk1(F_i[q], p[place(i, q)]); }),
                                     Pack(scale) * batches_[i].volume, g);
      }
    });
  }

  void add_couplings(Couplings& couplings) const override {
    for (const Batch& batch : batches_)
      for (int l = 0; l < batch.count; ++l)
        for (size_t u = 0; u < batch.vertex.size(); ++u)
          for (size_t v = 0; v < u; ++v) couplings.emplace_back(batch.vertex[u][l], batch.vertex[v][l]);
  }

  void bind(const BlockPattern& pattern) override {
    parallel_for(batch_count(), [&](int i) { batches_[i].bind(pattern); });
  }

  int add_hessian(Positions x, const Context& context, double scale, const Projection& projection,
                  BlockSparse& H) const override {
    const std::vector<Params<Pack>>& p = params(context);
    thread_local std::vector<char> scratch;  // number of modified lanes per batch
    std::vector<char>& projected = scratch;  // shared by all terms of this thread
    projected.assign(batches_.size(), 0);
    for_each_batch([&](int i) {
      if (i + 1 < batch_count()) batches_[i + 1].prefetch_blocks(H);
      projected[i] = add_batch_hessian({i, &p[place(i, 0)], Pack(scale) * batches_[i].volume}, x, projection, H);
    });
    return std::accumulate(projected.begin(), projected.end(), 0);
  }

 protected:
  static constexpr int kPoints = Batch::kPoints;
  using Points = typename Batch::Points;  // one matrix per quadrature point

  Points F(int batch, Positions x) const {
    const Points Ds = batches_[batch].edges(x);
    return at_points([&](int q) { return at(Ds, q) * batches_[batch].rest_inverse; });
  }
  // An entry of one matrix per quadrature point, and all from a function of the point. Linear tets have only one, and
  // no array: it would cost registers.
  static const Mat3<Pack>& at(const Points& points, int q) {
    if constexpr (kPoints == 1)
      return points;
    else
      return points[q];
  }
  template <class OfPoint>
  static auto at_points(const OfPoint& of_point) {
    if constexpr (kPoints == 1) {
      return of_point(0);
    } else {
      std::array<decltype(of_point(0)), kPoints> values;
      for (int q = 0; q < kPoints; ++q) values[q] = of_point(q);
      return values;
    }
  }
  // Returns whether the law is zero around F, for laws that often are.
  static bool is_zero(const Points& F_i) {
    if constexpr (requires { M::is_zero(at(F_i, 0)); })
      return std::all_of(F_i.begin(), F_i.end(), [](const Mat3<Pack>& F_q) { return M::is_zero(F_q); });
    return false;
  }
  static int place(int batch, int point) { return kPoints * batch + point; }  // in the list of parameters

  // Returns the sum of psi over the quadrature points.
  Pack density_sum(int batch, const Points& F_i, const std::vector<Params<Pack>>& p) const {
    Pack psi = material_.psi(at(F_i, 0), p[place(batch, 0)]);
    for (int q = 1; q < kPoints; ++q) psi += material_.psi(at(F_i, q), p[place(batch, q)]);
    return psi;
  }
  int batch_count() const { return static_cast<int>(batches_.size()); }

  // Calls body(batch) for all batches: color after color, with the groups of a color in parallel.
  template <class Body>
  void for_each_batch(const Body& body) const {
    for (const std::vector<int>& groups : colors_)
      parallel_for(static_cast<int>(groups.size()), [&](int k) { for_group(groups[k], body); });
  }

  // Combines one value per batch, in the order of the batches.
  template <class Body, class Combine>
  double reduce(const Body& body, const Combine& combine, double start) const {
    thread_local std::vector<double> scratch;
    std::vector<double>& partial = scratch;  // shared by all terms of this thread
    partial.resize(group_count());
    parallel_for(group_count(), [&](int group) {
      double result = start;
      for_group(group, [&](int i) { result = combine(result, body(i)); });
      partial[group] = result;
    });
    double result = start;
    for (const double p : partial) result = combine(result, p);
    return result;
  }

  // Returns the parameters of each batch and quadrature point in a step.
  virtual const std::vector<Params<Pack>>& params(const Energy::Context&) const { return params_; }

  [[no_unique_address]] M material_;  // empty except for a CustomDensity
  LargeVector<Batch> batches_;
  std::vector<Params<Pack>> params_;

 private:
  // Returns tets [first, first + count) in an order that keeps neighbors close.
  static std::vector<int> locality_order(const TetMesh& mesh, int first, size_t count) {
    std::vector<int> order = morton_order(centroids(mesh, first, count));
    for (int& tet : order) tet += first;
    return order;
  }

  // Returns the number of tets per group: large enough for threads and caches, small enough to color small meshes.
  static size_t group_size(size_t tets) { return std::clamp<size_t>(std::bit_floor(tets / 128), 128, 1024); }

  // A batch contains every k-th tet of the group, because neighboring tets add to the same blocks, and each addition
  // would have to wait for the one before.
  template <class ParametersOf>
  void fill_group(int group, const TetMesh& mesh, std::span<const int> tets, const ParametersOf& parameters_of) {
    const size_t stride = (tets.size() + kPackWidth - 1) / kPackWidth;
    for (size_t i = 0; i < stride; ++i) {
      std::array<int, kPackWidth> own;
      std::array<Params<double>, kPackWidth> lanes;
      size_t count = 0;
      for (size_t l = 0; l < kPackWidth; ++l) {
        const size_t j = i + l * stride;
        if (j < tets.size()) ++count;
        own[l] = tets[j < tets.size() ? j : i];
        lanes[l] = parameters_of(own[l]);
      }
      const size_t batch = group * batches_per_group() + i;
      batches_[batch] = Batch(mesh, std::span(own).first(count));
      for (int q = 0; q < kPoints; ++q) params_[kPoints * batch + q] = pack_params<M>(lanes);
    }
  }

  struct WeightedBatch {
    int i;
    const Params<Pack>* params;  // one per quadrature point
    Pack weight;
  };

  // Returns the number of modified lanes.
  char add_batch_hessian(const WeightedBatch& batch, Positions x, const Projection& projection, BlockSparse& H) const {
    const Batch& tets = batches_[batch.i];
    const Params<Pack>* p = batch.params;
    const Pack weight = batch.weight;
    if constexpr (requires { &M::is_zero; })
      if (is_zero(F(batch.i, x))) return 0;
    if constexpr (requires { typename M::Law; }) {
      if (projection.kind == Definiteness::exact) {
        const Points Ds = tets.edges(x);
        if constexpr (kPoints == 1) {
          const LawBlocks blocks(tets, Ds, M::law_derivatives(Ds * tets.rest_inverse, p[0]), weight);
          tets.scatter_blocks([&](int u, int v) { return blocks.block(u, v); }, H);
        } else {
          const auto blocks_at = [&](int q) {
            return LawBlocks(tets, Ds[q], M::law_derivatives(Ds[q] * tets.rest_inverse, p[q]), weight);
          };
          tets.scatter_blocks(blocks_at, H);
        }
        return 0;
      }
    }
    const Points F_i = F(batch.i, x);
    unsigned projected = 0;
    const auto A = at_points([&](int q) {
      Mat9<Pack> A_q = material_.hessian(at(F_i, q), p[q]);
      projected |= project(A_q, at(F_i, q), p[q], tets.lanes_covered(projection), projection.kind);
      return A_q;
    });
    tets.scatter_hessian(A, weight, H);
    return static_cast<char>(std::popcount(projected));
  }

  // Returns the lanes whose Hessian was modified.
  static unsigned project(Mat9<Pack>& A, const Mat3<Pack>& F_i, const Params<Pack>& p, unsigned lanes,
                          Definiteness kind) {
    if (kind == Definiteness::exact || lanes == 0) return 0;
    const EigenvalueFilter filter =
        kind == Definiteness::clamped ? EigenvalueFilter::clamp : EigenvalueFilter::absolute;
    if constexpr (requires { typename M::Law; }) {
      return filter_eigenvalues(A, filter, lanes, [&] { return law_eigen(F_i, M::law_derivatives(F_i, p)); });
    } else {
      return modify_hessian(A, filter, lanes);
    }
  }

  int batches_per_group() const { return static_cast<int>(tets_per_group_) / kPackWidth; }
  int group_count() const { return (batch_count() + batches_per_group() - 1) / batches_per_group(); }

  template <class Body>
  void for_group(int group, const Body& body) const {
    constexpr int kAhead = 2;
    const int last = std::min(batch_count(), (group + 1) * batches_per_group());
    for (int i = group * batches_per_group(); i < last; ++i) {
      if (i + kAhead < batch_count()) {
        batches_[i + kAhead].prefetch();
        prefetch(&params_[place(i + kAhead, 0)], kPoints * sizeof params_[0]);
      }
      body(i);
    }
  }

  void color(int vertex_count) {
    std::vector<std::vector<int>> vertices(group_count());  // vertices of each group, without repeats
    std::vector<int> last_group(vertex_count, -1);
    for (int group = 0; group < group_count(); ++group)
      for_group(group, [&](int i) {
        for (const auto& corner : batches_[i].vertex)
          for (const int v : corner)
            if (std::exchange(last_group[v], group) != group) vertices[group].push_back(v);
      });
    colors_ = color_groups(vertices, vertex_count);
  }

  std::string name_;
  size_t tets_per_group_;
  ColorClasses colors_;
};

}  // namespace aspic
