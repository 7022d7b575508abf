// Reads slices of a .msh file, so that no process holds the whole mesh.
#pragma once
#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

class GmshSlices {
 public:
  // Reads the headers of the blocks. Returns nothing unless the file is a complete binary little-endian .msh 4.1 with
  // 4-node tets as its only solid elements: read_tet_mesh() reads the others, or reports what is wrong.
  static std::optional<GmshSlices> open(const std::filesystem::path& path);

  std::int64_t vertex_count() const { return nodes_.count; }
  std::int64_t tet_count() const { return tets_.count; }
  bool has_regions() const { return has_regions_; }
  int region(std::int64_t tet) const;

  // Return vertices and tets as read_tet_mesh() does. Throw InvalidInput if the file cannot be read, a coordinate is
  // not finite, or tags of nodes are not consecutive.
  std::vector<Vec3d> vertices(std::int64_t first, std::int64_t count) const;
  std::vector<Tet> tets(std::int64_t first, std::int64_t count) const;

 private:
  struct Block {
    std::int64_t first, count, position;  // `position` of its first byte after the header
    int label;
  };
  struct Blocks {
    std::vector<Block> list;
    std::int64_t count = 0;

    void add(std::int64_t items, std::int64_t position, int label);
    const Block& at(std::int64_t item) const;
  };
  class Headers;

  [[noreturn]] void fail(const std::string& message) const;

  std::string path_;
  Blocks nodes_, tets_;
  std::int64_t first_tag_ = 0;
  bool has_regions_ = false;
};

}  // namespace aspic
