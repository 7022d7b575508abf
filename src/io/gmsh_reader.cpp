#include <algorithm>
#include <climits>
#include <cstdlib>
#include <map>
#include <span>

#include "io/gmsh.h"
#include "io/gmsh_elements.h"
#include "io/gmsh_source.h"

namespace aspic {
namespace {

class GmshReader {
 public:
  GmshReader(const std::string& file, std::string_view contents) : text_(file, contents, TextScanner::kNoComments) {}

  MeshContent read() {
    read_format();
    while (!text_.at_end()) read_section();
    if (!has_nodes_) text_.fail("the file has no $Nodes; export the mesh again");
    if (content_.tets.empty() && content_.triangles.empty() && !lost_.empty())
      text_.fail("the mesh has " + std::string(lost_) + ", which are not read; export it in first order");
    set_regions();
    set_groups();
    return std::move(content_);
  }

 private:
  void expect(std::string_view word) {
    const std::string_view found = text_.word(word);
    if (found != word)
      text_.fail("found " + shown(found) + " where '" + std::string(word) +
                 "' should be; the counts do not fit the file, or it is no .msh file");
  }

  // $MeshFormat: version, 0 (text) or 1 (binary), size of a double; in binary files then the integer 1.
  void read_format() {
    if (text_.peek() == "$NOD") {
      text_.word("$NOD");
      text_.fail(std::string("this is Gmsh 1 ($NOD), which is not read; ") + kSaveAgain);
    }
    expect("$MeshFormat");
    const double version = text_.number("the version");
    is_4_ = version == 4.1;
    if (!is_4_ && !(version >= 2 && version < 3))
      text_.fail("version " + std::to_string(version).substr(0, 3) + " is not read; " + kSaveAgain);
    const int64_t is_binary = text_.integer("the file type");
    if (is_binary != 0 && is_binary != 1)
      text_.fail("the file type is " + std::to_string(is_binary) + "; it must be 0 (text) or 1 (binary)");
    if (const int64_t size = text_.integer("the size of a number"); size != 8)
      text_.fail("the size of a number is " + std::to_string(size) + " bytes; save the mesh with 8");
    text_.skip_line();
    if (is_binary) {
      ByteCursor bytes(text_.file(), text_.text(), text_.position());
      const int one = bytes.read<int32_t>("the integer 1");
      if (one != 1 && one != 1 << 24) bytes.fail("the integer 1 is missing; the file was damaged as if it were text");
      data_ = one == 1 ? GmshData::little_endian : GmshData::big_endian;
      text_.seek(bytes.position());
    }
    expect("$EndMeshFormat");
  }

  void read_section() {
    const std::string name(text_.word("a section"));
    if (name[0] != '$' || name.starts_with("$End"))
      text_.fail("found " + shown(name) + " where a section such as $Nodes should begin; remove it");
    const std::string end = "$End" + name.substr(1);
    if (name == "$PartitionedEntities")
      text_.fail("the mesh is partitioned; save it in one piece (Mesh > Unpartition in Gmsh)");
    if (const bool is_parametric = name == "$ParametricNodes" && !is_4_; is_parametric || name == "$Nodes") {
      if (std::exchange(has_nodes_, true)) text_.fail("a second section $Nodes; merge it with the first");
      text_.skip_line();
      is_4_ ? read_nodes_4() : read_nodes_2(is_parametric);
      if (const auto twice = tags_.prepare())
        text_.fail("two nodes have the tag " + std::to_string(*twice) + "; renumber them");
    } else if (name == "$Elements") {
      if (!has_nodes_) text_.fail("$Elements comes before $Nodes; put the nodes first");
      text_.skip_line();
      is_4_ ? read_elements_4() : read_elements_2();
    } else if (name == "$PhysicalNames") {
      read_names();
    } else if (name == "$Entities" && is_4_) {
      text_.skip_line();
      read_entities();
    } else {
      const size_t place = text_.text().find(end, text_.position());
      if (place == std::string_view::npos)
        text_.fail(shown(name) + " has no " + shown(end) + "; it is cut short, get a complete copy");
      text_.seek(place);
    }
    expect(end);
  }

  GmshSource source() const { return {text_.file(), text_.text(), text_.position(), data_}; }

  Vec3d read_point(GmshSource& in) {
    Vec3d point;
    for (double& coordinate : point.a) coordinate = in.number("a node's coordinate");
    return point;
  }

  // A count, then dimension, number and name of each group; text in every file.
  void read_names() {
    const int count = text_.count("the number of physical names", 6);
    for (int i = 0; i < count; ++i) {
      const int64_t dimension = text_.integer("the dimension of a physical group");
      const int group = text_.small_integer("the number of a physical group");
      const std::string name = printable(text_.quoted("a physical name"));
      if (dimension == 2) surface_names_[group] = name;
      if (dimension == 3) volume_names_[group] = name;
    }
  }

  // Version 2: a count, always as text; then tag x y z, with dimension, tag and parameters of the entity if parametric.
  void read_nodes_2(bool is_parametric) {
    const int64_t count = text_.integer("the number of nodes");
    text_.skip_line();
    GmshSource in = source();
    const int checked = in.checked_count(count, "the number of nodes", 4, 28);
    content_.vertices.reserve(static_cast<size_t>(checked));
    for (int i = 0; i < checked; ++i) {
      tags_.add(in.integer("the tag of a node"));
      content_.vertices.push_back(read_point(in));
      if (!is_parametric) continue;
      const int dimension = in.integer("the dimension of a node's entity");
      in.integer("the tag of a node's entity");
      if (dimension == 1 || dimension == 2) in.skip_numbers(dimension, "a node's parameter");
    }
    text_.seek(in.position());
  }

  // Version 4: one block per entity: tags, then points, with parameters on the entity if flagged.
  void read_nodes_4() {
    GmshSource in = source();
    const int64_t blocks = in.size("the number of blocks"), count = in.size("the number of nodes");
    in.skip_sizes(2, "the smallest and largest tag");
    const int checked_blocks = in.checked_count(blocks, "the number of blocks", 4, 20);
    for (int block = 0; block < checked_blocks; ++block) {
      const int dimension = in.integer("the dimension of an entity");
      in.integer("the tag of an entity");
      const bool is_parametric = in.integer("'parametric'") != 0;
      if (dimension < 0 || dimension > 3)
        in.fail("an entity has dimension " + std::to_string(dimension) + "; it must be 0 to 3");
      const int nodes =
          in.checked_count(in.size("the number of nodes of a block"), "the number of nodes of a block", 4, 32);
      for (int i = 0; i < nodes; ++i) tags_.add(in.size("the tag of a node"));
      for (int i = 0; i < nodes; ++i) {
        content_.vertices.push_back(read_point(in));
        if (is_parametric) in.skip_numbers(dimension, "a node's parameter");
      }
    }
    if (count != static_cast<int64_t>(content_.vertices.size()))
      in.fail("$Nodes states " + std::to_string(count) + " nodes, but its blocks hold " +
              std::to_string(content_.vertices.size()) + "; get a complete copy");
    text_.seek(in.position());
  }

  // $Entities lists the physical groups of each entity; those of volumes and surfaces are kept.
  void read_entities() {
    GmshSource in = source();
    int64_t counts[4];
    for (int64_t& count : counts) count = in.size("the number of entities");
    for (int dimension = 0; dimension < 4; ++dimension) {
      const int entities = in.checked_count(counts[dimension], "the number of entities", 5, 36);
      for (int i = 0; i < entities; ++i) {
        const int tag = in.integer("the tag of an entity");
        in.skip_numbers(dimension == 0 ? 3 : 6, "the bounding box of an entity");
        const int groups =
            in.checked_count(in.size("the number of physical groups"), "the number of physical groups", 1, 4);
        for (int g = 0; g < groups; ++g) {
          const int group = in.integer("a physical group");
          if (dimension == 3 && g == 0) volume_groups_[tag] = group;
          if (dimension == 2)
            surface_groups_[tag].push_back(std::abs(std::max(group, -INT_MAX)));  // negative: reversed
        }
        if (dimension > 0)
          in.skip_integers(in.size("the number of bounding entities"), "the number of bounding entities");
      }
    }
    text_.seek(in.position());
  }

  const GmshElementType& checked_type(GmshSource& in, int number) {
    const GmshElementType* type = gmsh_element_type(number);
    if (!type) in.fail("element type " + std::to_string(number) + " is unknown; export 4-node tets or triangles");
    if (type->dimension == 3 && number != kGmshTet && number != kGmshQuadraticTet)
      in.fail("the mesh has " + std::string(type->name) +
              ", which are not read; export it with 4-node or 10-node tets only");
    if (type->dimension == 2 && number != kGmshTriangle && number != kGmshQuadrangle) lost_ = type->name;
    return *type;
  }

  int corner(GmshSource& in, int64_t tag) {
    const auto index = tags_.index(tag);
    if (!index) in.fail("an element names node " + std::to_string(tag) + ", which $Nodes does not have; correct it");
    return *index;
  }

  // Version 2 stores node tags as 4-byte integers, version 4 as 8-byte integers.
  void read_element(GmshSource& in, const GmshElementType& type, int group, int entity) {
    constexpr std::string_view kWhat = "a node of an element";
    const bool is_tet = type.number == kGmshTet || type.number == kGmshQuadraticTet;
    const int face_corners = gmsh_face_corners(type.number);
    if (!is_tet && face_corners == 0)
      return is_4_ ? in.skip_sizes(type.nodes, kWhat) : in.skip_integers(type.nodes, kWhat);
    std::array<int, 10> nodes;
    nodes.fill(-1);
    for (int i = 0; i < type.nodes; ++i) nodes[i] = corner(in, is_4_ ? in.size(kWhat) : in.integer(kWhat));
    if (!is_tet) return add_face({nodes.data(), static_cast<size_t>(face_corners)}, type, group, entity);
    content_.tets.push_back({nodes[0], nodes[1], nodes[2], nodes[3]});
    if (type.number == kGmshQuadraticTet || !content_.mids.empty()) {
      content_.mids.resize(content_.tets.size(), {-1, -1, -1, -1, -1, -1});
      std::copy(nodes.begin() + 4, nodes.end(), content_.mids.back().begin());
    }
    groups_.push_back(group);
    entities_.push_back(entity);
  }

  void add_face(std::span<const int> corners, const GmshElementType& type, int group, int entity) {
    if (type.nodes == static_cast<int>(corners.size())) add_fan(corners, content_.triangles);
    const auto groups = surface_groups_.find(entity);
    if (!is_4_ || groups == surface_groups_.end() || groups->second.empty())
      return add_fan(corners, surfaces_[group != 0 ? group : entity]);
    for (const int label : groups->second) add_fan(corners, surfaces_[label]);
  }

  // Element tags in version 2: physical group, elementary entity, then partitions.
  void read_element_2(GmshSource& in, const GmshElementType& type, int64_t tags) {
    const int group = tags > 0 ? in.integer("a physical group") : 0;
    const int entity = tags > 1 ? in.integer("an elementary entity") : 0;
    if (tags > 2) in.skip_integers(tags - 2, "the number of tags");
    read_element(in, type, group, entity);
  }

  // Text: number type tag-count tags nodes. Binary: blocks (type, count, tag-count) of (number, tags, nodes).
  void read_elements_2() {
    const int64_t count = text_.integer("the number of elements");
    text_.skip_line();
    GmshSource in = source();
    const int elements = in.checked_count(count, "the number of elements", 4, 8);
    for (int done = 0; done < elements;) {
      if (!in.is_binary()) in.integer("the number of an element");
      const GmshElementType& type = checked_type(in, in.integer("the type of an element"));
      const int block = in.is_binary() ? in.integer("the number of elements of a block") : 1;
      const int tags = in.integer("the number of tags");
      if (block < 1 || block > elements - done)
        in.fail("a block has " + std::to_string(block) + " of the " + std::to_string(elements - done) +
                " elements that are left; the file is damaged, get a complete copy");
      if (tags < 0) in.fail("an element has " + std::to_string(tags) + " tags; it must not be negative");
      for (int i = 0; i < block; ++i) {
        if (in.is_binary()) in.integer("the number of an element");
        read_element_2(in, type, tags);
      }
      done += block;
    }
    text_.seek(in.position());
  }

  void read_elements_4() {
    GmshSource in = source();
    const int64_t blocks = in.size("the number of blocks"), count = in.size("the number of elements");
    in.skip_sizes(2, "the smallest and largest tag");
    const int checked_blocks = in.checked_count(blocks, "the number of blocks", 4, 20);
    int64_t total = 0;
    for (int block = 0; block < checked_blocks; ++block) {
      in.integer("the dimension of an entity");
      const int entity = in.integer("the tag of an entity");
      const GmshElementType& type = checked_type(in, in.integer("the type of an element"));
      const auto words = 1 + static_cast<size_t>(type.nodes);
      const int elements = in.checked_count(in.size("the number of elements of a block"),
                                            "the number of elements of a block", words, 8 * words);
      const auto group = volume_groups_.find(entity);
      for (int i = 0; i < elements; ++i) {
        in.size("the tag of an element");
        read_element(in, type, group == volume_groups_.end() ? 0 : group->second, entity);
      }
      total += elements;
    }
    if (count != total)
      in.fail("$Elements states " + std::to_string(count) + " elements, but its blocks hold " + std::to_string(total) +
              "; get a complete copy");
    text_.seek(in.position());
  }

  // Without physical groups, a single entity of all tets is no label.
  void set_regions() {
    const auto is_zero = [](int label) { return label == 0; };
    const bool has_groups = !std::all_of(groups_.begin(), groups_.end(), is_zero);
    const bool is_one_entity = std::equal(entities_.begin() + !entities_.empty(), entities_.end(), entities_.begin());
    if (!has_groups && is_one_entity) return;
    for (size_t t = 0; t < groups_.size(); ++t) content_.region.push_back(groups_[t] != 0 ? groups_[t] : entities_[t]);
  }

  void set_groups() {
    if (content_.tets.empty()) return;
    for (auto& [label, triangles] : surfaces_) {
      const auto name = surface_names_.find(label);
      content_.groups.surfaces.push_back(
          {label, name == surface_names_.end() ? "" : name->second, std::move(triangles)});
    }
    for (const auto& [label, name] : volume_names_)
      if (std::find(groups_.begin(), groups_.end(), label) != groups_.end()) content_.groups.region_names[label] = name;
  }

  static constexpr const char* kSaveAgain = "save it again with 'gmsh IN.msh -save -format msh41 -o OUT.msh'";

  TextScanner text_;
  MeshContent content_;
  GmshData data_ = GmshData::text;
  bool is_4_ = false, has_nodes_ = false;
  GmshTags tags_;
  std::map<int, int> volume_groups_;                // entity -> first physical group
  std::map<int, std::vector<int>> surface_groups_;  // entity -> physical groups
  std::map<int, std::string> volume_names_, surface_names_;
  std::map<int, std::vector<Triangle>> surfaces_;  // by physical group, or else by entity
  std::vector<int> groups_, entities_;             // per tet; group 0: none
  std::string_view lost_;                          // surface elements that are skipped
};

}  // namespace

MeshContent parse_gmsh(const std::string& file, std::string_view contents) { return GmshReader(file, contents).read(); }

}  // namespace aspic
