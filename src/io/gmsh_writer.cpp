#include "io/gmsh.h"
#include "io/gmsh_elements.h"
#include "io/number_text.h"

namespace aspic {
namespace {

class GmshWriter {
 public:
  explicit GmshWriter(FileEncoding encoding) : is_binary_(encoding == FileEncoding::binary) {
    out_ = is_binary_ ? "$MeshFormat\n2.2 1 8\n" : "$MeshFormat\n2.2 0 8\n";
    if (is_binary_) {
      append_bytes(out_, int32_t{1});
      out_ += '\n';
    }
    out_ += "$EndMeshFormat\n";
  }

  void add_nodes(const std::vector<Vec3d>& vertices) {
    out_ += "$Nodes\n" + std::to_string(vertices.size()) + '\n';
    for (size_t v = 0; v < vertices.size(); ++v) {
      const int tag = static_cast<int>(v) + 1;
      if (is_binary_) {
        append_bytes(out_, tag);
        append_bytes(out_, vertices[v]);
      } else {
        append_number(out_, tag);
        out_ += ' ';
        append_point(out_, vertices[v]);
        out_ += '\n';
      }
    }
    out_ += is_binary_ ? "\n$EndNodes\n" : "$EndNodes\n";
  }

  // group(i) and entity(i) are the labels of element i.
  template <class Element, class Group, class Entity>
  std::string finish(int type, const std::vector<Element>& elements, Group group, Entity entity) {
    out_ += "$Elements\n" + std::to_string(elements.size()) + '\n';
    if (is_binary_ && !elements.empty())
      append_bytes(out_, std::array<int32_t, 3>{type, static_cast<int32_t>(elements.size()), 2});
    for (size_t i = 0; i < elements.size(); ++i) {
      const int number = static_cast<int>(i) + 1;
      if (is_binary_) {
        append_bytes(out_, std::array<int32_t, 3>{number, group(i), entity(i)});
        for (const int vertex : elements[i]) append_bytes(out_, vertex + 1);
      } else {
        append_number(out_, number);
        append_indices(out_, std::array{type, 2, group(i), entity(i)}, 0);
        append_indices(out_, elements[i], 1);
        out_ += '\n';
      }
    }
    out_ += is_binary_ ? "\n$EndElements\n" : "$EndElements\n";
    return std::move(out_);
  }

 private:
  bool is_binary_;
  std::string out_;
};

}  // namespace

// Writes labels as group and as entity, so that label 0 reads back, which as a group means none.
std::string gmsh_bytes(const TetMesh& mesh, FileEncoding encoding) {
  GmshWriter writer(encoding);
  writer.add_nodes(mesh.rest);
  const auto group = [&](size_t t) { return mesh.region.empty() ? 0 : mesh.region[t]; };
  const auto entity = [&](size_t t) { return mesh.region.empty() ? 1 : mesh.region[t]; };
  return writer.finish(kGmshTet, mesh.tets, group, entity);
}

std::string gmsh_bytes(const TriMesh& mesh, FileEncoding encoding) {
  GmshWriter writer(encoding);
  writer.add_nodes(mesh.vertices);
  return writer.finish(
      kGmshTriangle, mesh.triangles, [](size_t) { return 0; }, [](size_t) { return 1; });
}

}  // namespace aspic
