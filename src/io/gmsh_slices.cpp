#include "io/gmsh_slices.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <set>

#include "base/error.h"
#include "io/gmsh_elements.h"
#include "io/input_file.h"

namespace aspic {
namespace {

constexpr std::int64_t kWord = 8;         // bytes of a tag or coordinate
constexpr std::int64_t kTetRecord = 5;    // words: its tag and four nodes
constexpr std::int64_t kChunk = 1 << 16;  // items that are read together

template <class T>
void read_words(std::ifstream& in, std::int64_t position, std::vector<T>& words) {
  static_assert(sizeof(T) == kWord);
  in.seekg(position);
  in.read(reinterpret_cast<char*>(words.data()), static_cast<std::streamsize>(words.size() * sizeof(T)));
}

}  // namespace

void GmshSlices::Blocks::add(std::int64_t items, std::int64_t position, int label) {
  if (items > 0) list.push_back({count, items, position, label});
  count += items;
}

const GmshSlices::Block& GmshSlices::Blocks::at(std::int64_t item) const {
  return *std::prev(std::upper_bound(list.begin(), list.end(), item,
                                     [](std::int64_t value, const Block& block) { return value < block.first; }));
}

// Reads the headers of the sections and their blocks.
class GmshSlices::Headers {
 public:
  explicit Headers(const std::filesystem::path& path) : in_(try_open_input(path)) {
    in_.seekg(0, std::ios::end);
    size_ = in_.tellg();
    in_.seekg(0);
    slices_.path_ = path.string();
  }

  std::optional<GmshSlices> read() {
    if (std::endian::native != std::endian::little || !in_ || !read_format()) return std::nullopt;
    std::set<std::string> seen;
    for (std::string name; in_ >> name;)
      if (!seen.insert(name).second || !read_section(name)) return std::nullopt;
    if (slices_.nodes_.count == 0 || slices_.tets_.count == 0) return std::nullopt;
    set_regions();
    std::vector<std::int64_t> tag(1);
    in_.clear();
    read_words(in_, slices_.nodes_.list[0].position, tag);
    slices_.first_tag_ = tag[0];
    // Tags are positive. Differences of others might overflow.
    if (tag[0] <= 0 || tag[0] > std::numeric_limits<std::int64_t>::max() - slices_.nodes_.count) return std::nullopt;
    return in_ ? std::optional(std::move(slices_)) : std::nullopt;
  }

 private:
  template <class T>
  T get() {
    T value = 0;
    in_.read(reinterpret_cast<char*>(&value), sizeof(T));
    return value;
  }
  bool expect(const std::string& word) {
    std::string found;
    return in_ >> found && found == word;
  }
  // Skips items of `bytes` each. Returns false if the file ends before.
  bool skip(std::int64_t items, std::int64_t bytes) {
    const std::int64_t rest = size_ - in_.tellg();
    if (!in_ || items < 0 || items > rest / bytes) return false;
    in_.seekg(items * bytes, std::ios::cur);
    return true;
  }

  bool read_format() {
    const bool is_binary = expect("$MeshFormat") && expect("4.1") && expect("1") && expect("8") && in_.get() == '\n';
    return is_binary && get<std::int32_t>() == 1 && expect("$EndMeshFormat");
  }

  bool read_section(const std::string& name) {
    const bool is_read = name == "$Nodes" || name == "$Elements" || name == "$Entities";
    if (name == "$PartitionedEntities" || in_.get() != '\n') return false;
    if (name == "$Nodes" && !read_nodes()) return false;
    if (name == "$Elements" && (slices_.nodes_.count == 0 || !read_elements())) return false;
    if (name == "$Entities" && !read_entities()) return false;
    const std::string end = "$End" + name.substr(1);
    if (is_read) return expect(end);
    for (std::string line; std::getline(in_, line);)
      if (line == end) return true;
    return false;
  }

  bool read_nodes() {
    const auto blocks = get<std::int64_t>(), count = get<std::int64_t>();
    skip(2, kWord);
    for (std::int64_t b = 0; b < blocks && in_; ++b) {
      skip(2, sizeof(std::int32_t));
      const bool is_parametric = get<std::int32_t>() != 0;
      const auto nodes = get<std::int64_t>();
      const std::int64_t position = in_.tellg();
      if (is_parametric || !skip(nodes, 4 * kWord)) return false;
      slices_.nodes_.add(nodes, position, 0);
    }
    return in_ && slices_.nodes_.count == count;
  }

  bool read_elements() {
    const auto blocks = get<std::int64_t>(), count = get<std::int64_t>();
    skip(2, kWord);
    std::int64_t total = 0;
    for (std::int64_t b = 0; b < blocks && in_; ++b) {
      skip(1, sizeof(std::int32_t));
      const auto entity = get<std::int32_t>();
      const GmshElementType* type = gmsh_element_type(get<std::int32_t>());
      const auto elements = get<std::int64_t>();
      const std::int64_t position = in_.tellg();
      if (!type || (type->dimension == 3 && type->number != kGmshTet) || !skip(elements, (1 + type->nodes) * kWord))
        return false;
      if (type->number == kGmshTet) slices_.tets_.add(elements, position, entity);
      total += elements;
    }
    return in_ && total == count;
  }

  bool read_entities() {
    std::array<std::int64_t, 4> counts;
    for (std::int64_t& count : counts) count = get<std::int64_t>();
    for (int dimension = 0; dimension < 4; ++dimension)
      for (std::int64_t i = 0; i < counts[dimension]; ++i) {
        const auto tag = get<std::int32_t>();
        if (!skip(dimension == 0 ? 3 : 6, kWord)) return false;
        const auto groups = get<std::int64_t>();
        if (groups > 0) {
          const auto group = get<std::int32_t>();
          if (dimension == 3) volume_groups_[tag] = group;
          if (!skip(groups - 1, sizeof(std::int32_t))) return false;
        }
        if (dimension > 0 && !skip(get<std::int64_t>(), sizeof(std::int32_t))) return false;
      }
    return true;
  }

  // As in parse_gmsh(): without physical groups, a single entity of all tets is no label.
  void set_regions() {
    std::vector<Block>& list = slices_.tets_.list;
    const int entity = list[0].label;
    bool has_groups = false, is_one_entity = true;
    for (Block& block : list) {
      is_one_entity = is_one_entity && block.label == entity;
      const auto group = volume_groups_.find(block.label);
      if (group == volume_groups_.end() || group->second == 0) continue;
      has_groups = true;
      block.label = group->second;
    }
    slices_.has_regions_ = has_groups || !is_one_entity;
  }

  std::ifstream in_;
  std::int64_t size_ = 0;
  GmshSlices slices_;
  std::map<int, int> volume_groups_;
};

std::optional<GmshSlices> GmshSlices::open(const std::filesystem::path& path) { return Headers(path).read(); }

int GmshSlices::region(std::int64_t tet) const { return tets_.at(tet).label; }

void GmshSlices::fail(const std::string& message) const { throw InvalidInput(path_ + ": " + message); }

std::vector<Vec3d> GmshSlices::vertices(std::int64_t first, std::int64_t count) const {
  std::ifstream in = open_input(path_);
  std::vector<Vec3d> result;
  result.reserve(static_cast<size_t>(count));
  std::vector<std::int64_t> tags;
  std::vector<double> numbers;
  for (std::int64_t v = first; v < first + count;) {
    const Block& block = nodes_.at(v);
    const std::int64_t from = v - block.first, here = std::min({kChunk, block.count - from, first + count - v});
    tags.resize(static_cast<size_t>(here));
    numbers.resize(static_cast<size_t>(3 * here));
    read_words(in, block.position + kWord * from, tags);
    read_words(in, block.position + kWord * (block.count + 3 * from), numbers);
    if (!in) fail("cannot be read; get a complete copy");
    for (std::int64_t i = 0; i < here; ++i, ++v) {
      const double* x = &numbers[3 * i];
      if (tags[i] != first_tag_ + v) fail("the tags of its nodes are not consecutive; renumber them");
      if (!std::isfinite(x[0] + x[1] + x[2]))
        fail("node " + std::to_string(tags[i]) + " has a coordinate that is not finite; correct it");
      result.push_back({{x[0], x[1], x[2]}});
    }
  }
  return result;
}

std::vector<Tet> GmshSlices::tets(std::int64_t first, std::int64_t count) const {
  std::ifstream in = open_input(path_);
  std::vector<Tet> result;
  result.reserve(static_cast<size_t>(count));
  std::vector<std::int64_t> words;
  for (std::int64_t t = first; t < first + count;) {
    const Block& block = tets_.at(t);
    const std::int64_t from = t - block.first, here = std::min({kChunk, block.count - from, first + count - t});
    words.resize(static_cast<size_t>(kTetRecord * here));
    read_words(in, block.position + kWord * kTetRecord * from, words);
    if (!in) fail("cannot be read; get a complete copy");
    for (std::int64_t i = 0; i < here; ++i, ++t) {
      Tet& tet = result.emplace_back();
      for (int c = 0; c < 4; ++c) {
        const std::int64_t tag = words[kTetRecord * i + 1 + c];
        if (tag < first_tag_ || tag - first_tag_ >= nodes_.count)
          fail("an element names node " + std::to_string(tag) + ", which $Nodes does not have; correct it");
        tet[c] = static_cast<int>(tag - first_tag_);
      }
    }
  }
  return result;
}

}  // namespace aspic
