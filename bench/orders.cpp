// Effect of the order of vertices and tets: product with the Hessian, and gradient of elasticity, on one mesh in
// several orders. CPU time on one thread, minimum of several rounds that alternate between the orders. usage:
// bench_orders MESH [ROUNDS]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "bench/stopwatch.h"
#include "energy/tet_elasticity.h"
#include "io/mesh_file.h"
#include "mesh/order.h"

namespace {

using namespace aspic;

std::vector<int> inverse_of(const std::vector<int>& order) {
  std::vector<int> inverse(order.size());
  for (size_t i = 0; i < order.size(); ++i) inverse[order[i]] = static_cast<int>(i);
  return inverse;
}

TetMesh reordered(const TetMesh& mesh, const std::vector<int>& vertices, const std::vector<int>& tets) {
  const std::vector<int> place = inverse_of(vertices);
  TetMesh result;
  for (const int v : vertices) result.rest.push_back(mesh.rest[v]);
  for (const int t : tets) {
    result.tets.push_back(mesh.tets[t]);
    for (int& corner : result.tets.back()) corner = place[corner];
  }
  return result;
}

std::vector<int> natural_order(size_t count) {
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  return order;
}

std::vector<int> shuffled_order(size_t count) {
  std::vector<int> order = natural_order(count);
  std::shuffle(order.begin(), order.end(), std::mt19937(1));
  return order;
}

// Reverse breadth-first order from a peripheral vertex, neighbors of low degree first [CuthillMcKee1969].
std::vector<int> reverse_cuthill_mckee(const TetMesh& mesh) {
  const int n = mesh.vertex_count();
  std::vector<std::vector<int>> neighbors(n);
  for (const Tet& tet : mesh.tets)
    for (const int u : tet)
      for (const int v : tet)
        if (u != v) neighbors[u].push_back(v);
  for (auto& list : neighbors) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  const auto breadth_first = [&](int start, std::vector<char>& met) {
    std::vector<int> order = {start};
    met[start] = 1;
    for (size_t i = 0; i < order.size(); ++i) {
      std::vector<int> fresh;
      for (const int v : neighbors[order[i]])
        if (!met[v]) met[v] = 1, fresh.push_back(v);
      std::sort(fresh.begin(), fresh.end(), [&](int a, int b) { return neighbors[a].size() < neighbors[b].size(); });
      order.insert(order.end(), fresh.begin(), fresh.end());
    }
    return order;
  };
  std::vector<int> order;
  std::vector<char> met(n, 0);
  for (int v = 0; v < n; ++v) {
    if (met[v]) continue;
    int start = v;
    for (int pass = 0; pass < 3; ++pass) {
      std::vector<char> scratch = met;
      start = breadth_first(start, scratch).back();
    }
    const std::vector<int> part = breadth_first(start, met);
    order.insert(order.end(), part.begin(), part.end());
  }
  std::reverse(order.begin(), order.end());
  return order;
}

// Orders tets by their smallest vertex, then the next, so that they follow the vertices.
std::vector<int> tets_along(const TetMesh& mesh, const std::vector<int>& vertices) {
  const std::vector<int> place = inverse_of(vertices);
  std::vector<std::pair<Tet, int>> keys;
  for (int t = 0; t < mesh.tet_count(); ++t) {
    Tet key = mesh.tets[t];
    for (int& corner : key) corner = place[corner];
    std::sort(key.begin(), key.end());
    keys.emplace_back(key, t);
  }
  std::sort(keys.begin(), keys.end());
  std::vector<int> order;
  for (const auto& [key, t] : keys) order.push_back(t);
  return order;
}

struct Case {
  std::string name;
  std::unique_ptr<TetElasticity> elasticity;
  BlockPattern pattern;
  std::unique_ptr<BlockSparse> H;
  std::vector<double> x, y;
  double product = INFINITY, gradient = INFINITY, hessian = INFINITY;  // [s]

  Case(std::string called, const TetMesh& mesh) : name(std::move(called)), y(3 * mesh.rest.size()) {
    const MaterialParameters soft{.lame = lame_from_young_poisson(1e5, 0.4)};
    elasticity = make_tet_elasticity("neo_hookean", mesh, 0, std::vector<MaterialParameters>(mesh.tet_count(), soft));
    for (const Vec3d& X : mesh.rest) x.insert(x.end(), {X[0] + 0.02 * X[1], 0.99 * X[1], X[2]});
    Couplings couplings;
    elasticity->add_couplings(couplings);
    pattern = make_pattern(mesh.vertex_count(), std::move(couplings));
    elasticity->bind(pattern);
    H = std::make_unique<BlockSparse>(pattern);
    H->set_zero();
    elasticity->add_hessian(x, 1, {Definiteness::exact}, *H);
  }

  template <class Work>
  static double seconds(const Work& work) {
    const bench::Stopwatch stopwatch;
    work();
    return stopwatch.cpu_seconds();
  }

  void measure() {
    constexpr int kProducts = 5;
    product = std::min(product, seconds([&] {
                                  for (int i = 0; i < kProducts; ++i) H->multiply(x, y);
                                }) / kProducts);
    gradient = std::min(gradient, seconds([&] { elasticity->add_gradient(x, 1, y); }));
    hessian = std::min(hessian, seconds([&] { elasticity->add_hessian(x, 1, {Definiteness::exact}, *H); }));
  }
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return std::fprintf(stderr, "usage: bench_orders MESH [ROUNDS]\n"), 2;
  const int rounds = argc > 2 ? std::atoi(argv[2]) : 5;
  set_thread_count(1);
  const TetMesh mesh = read_tet_mesh(argv[1]);
  const std::vector<int> morton = morton_order(mesh.rest), hilbert = hilbert_order(mesh.rest),
                         cuthill_mckee = reverse_cuthill_mckee(mesh), shuffled = shuffled_order(mesh.rest.size());
  const std::vector<Vec3d> centers = centroids(mesh);
  std::vector<std::unique_ptr<Case>> cases;
  const auto add = [&](const char* name, const std::vector<int>& vertices, const std::vector<int>& tets) {
    cases.push_back(std::make_unique<Case>(name, reordered(mesh, vertices, tets)));
  };
  add("as in the file", natural_order(mesh.rest.size()), natural_order(mesh.tets.size()));
  add("shuffled", shuffled, shuffled_order(mesh.tets.size()));
  add("Morton", morton, morton_order(centers));
  add("Hilbert", hilbert, hilbert_order(centers));
  add("Hilbert, tets by vertices", hilbert, tets_along(mesh, hilbert));
  add("reverse Cuthill-McKee", cuthill_mckee, tets_along(mesh, cuthill_mckee));
  for (int round = 0; round < rounds; ++round)
    for (const auto& c : cases) c->measure();
  const double blocks = static_cast<double>(cases[0]->pattern.block_count()), tets = mesh.tet_count();
  std::printf("%d vertices, %d tets\n%-26s %14s %14s %14s\n", mesh.vertex_count(), mesh.tet_count(), "", "product",
              "gradient", "Hessian");
  for (const auto& c : cases)
    std::printf("%-26s %8.2f ns/blk %8.2f ns/tet %8.2f ns/tet\n", c->name.c_str(), 1e9 * c->product / blocks,
                1e9 * c->gradient / tets, 1e9 * c->hessian / tets);
  return 0;
}
