#include "recording/npy.h"

#include <algorithm>

#include "base/printable.h"
#include "io/byte_cursor.h"
#include "io/text_scanner.h"

namespace aspic {
namespace {

constexpr std::string_view kMagic("\x93NUMPY", 6);
constexpr size_t kMaxDimensions = 8;

void append_utf8(std::string& text, uint32_t code) {
  const auto add = [&](uint32_t byte) { text += static_cast<char>(byte); };
  if (code < 0x80) return add(code);
  if (code < 0x800) return add(0xc0 | code >> 6), add(0x80 | (code & 0x3f));
  if (code < 0x10000) return add(0xe0 | code >> 12), add(0x80 | (code >> 6 & 0x3f)), add(0x80 | (code & 0x3f));
  add(0xf0 | (code >> 18 & 7)), add(0x80 | (code >> 12 & 0x3f)), add(0x80 | (code >> 6 & 0x3f)),
      add(0x80 | (code & 0x3f));
}

class NpyReader {
 public:
  NpyReader(const std::string& file, std::string_view contents)
      : file_(file), contents_(contents), data_(file, contents, 0) {}

  NpyArray read() {
    read_head();
    size_t count = 1;
    for (const size_t n : array_.shape) {
      if (n > 0 && count > contents_.size() / n)
        data_.fail("the shape of the array is larger than the file; it is damaged");
      count *= n;
    }
    data_.checked_count(static_cast<int64_t>(count), "the number of values", std::max<size_t>(width_, 1));
    for (size_t i = 0; i < count; ++i) read_value();
    if (is_fortran_) array_.numbers = in_c_order();
    return std::move(array_);
  }

 private:
  void read_head() {
    if (!contents_.starts_with(kMagic)) data_.fail("is no array of numpy; save it by numpy.save or numpy.savez");
    data_.skip(kMagic.size(), "the format");
    const int version = data_.read<uint8_t>("the version");
    data_.skip(1, "the version");
    const size_t length =
        version == 1 ? data_.read<uint16_t>("the length of the head") : data_.read<uint32_t>("the length of the head");
    const size_t begin = data_.position();
    data_.skip(length, "the head");
    const std::string_view head = contents_.substr(begin, length);
    is_fortran_ = value_of(head, "fortran_order").starts_with("True");
    read_type(value_of(head, "descr"));
    read_shape(value_of(head, "shape"));
  }

  // Text behind "'key':" in the dictionary of the head.
  std::string_view value_of(std::string_view head, const std::string& key) const {
    const size_t at = head.find("'" + key + "'");
    const size_t colon = at == std::string_view::npos ? at : head.find(':', at);
    if (colon == std::string_view::npos) data_.fail("the head has no '" + key + "'; the array is damaged");
    const size_t begin = head.find_first_not_of(' ', colon + 1);
    return begin == std::string_view::npos ? std::string_view() : head.substr(begin);
  }

  void read_type(std::string_view text) {
    const size_t end = text.empty() ? 0 : text.find('\'', 1);
    const std::string_view type =
        text.empty() || text[0] != '\'' || end == std::string_view::npos ? text : text.substr(1, end - 1);
    const std::optional<int64_t> size = type.size() > 2 ? parse_integer(type.substr(2)) : std::nullopt;
    order_ = !type.empty() && type[0] == '>' ? std::endian::big : std::endian::little;
    kind_ = type.size() > 1 ? type[1] : ' ';
    const bool is_number =
        size && ((kind_ == 'f' && (*size == 4 || *size == 8)) || (kind_ == 'i' && (*size == 4 || *size == 8)));
    const bool is_text = size && (kind_ == 'U' || kind_ == 'S') && *size > 0 && *size < 100'000;
    if (!is_number && !is_text)
      data_.fail("the type of the array is " + shown(type) +
                 "; known are float32, float64, int32, int64 and texts. Convert numbers by astype(float), texts by "
                 "astype(str)");
    size_ = static_cast<size_t>(*size);
    width_ = kind_ == 'U' ? 4 * size_ : size_;
    data_ = ByteCursor(file_, contents_, data_.position(), order_);
  }

  void read_shape(std::string_view text) {
    if (text.empty() || text[0] != '(') data_.fail("the head has no shape; the array is damaged");
    text = text.substr(1, text.find(')') - 1);
    while (!text.empty()) {
      const size_t comma = std::min(text.find(','), text.size());
      const size_t first = text.find_first_not_of(' ');
      if (first < comma) {
        const std::optional<int64_t> n = parse_integer(text.substr(first, comma - first));
        if (!n || *n < 0 || array_.shape.size() == kMaxDimensions) data_.fail("the shape of the array is damaged");
        array_.shape.push_back(static_cast<size_t>(*n));
      }
      text.remove_prefix(std::min(comma + 1, text.size()));
    }
  }

  void read_value() {
    if (kind_ == 'U' || kind_ == 'S') {
      std::string text;
      for (size_t i = 0; i < size_; ++i) {
        const uint32_t code = kind_ == 'U' ? data_.read<uint32_t>("a text") : data_.read<uint8_t>("a text");
        if (code != 0) append_utf8(text, code);
      }
      array_.texts.push_back(printable(text));
    } else if (kind_ == 'f') {
      array_.numbers.push_back(size_ == 8 ? data_.read<double>("a value") : data_.read<float>("a value"));
    } else {
      array_.numbers.push_back(size_ == 8 ? static_cast<double>(data_.read<int64_t>("a value"))
                                          : data_.read<int32_t>("a value"));
    }
  }

  std::vector<double> in_c_order() const {
    std::vector<double> sorted(array_.numbers.size());
    std::vector<size_t> index(array_.shape.size(), 0);
    for (double& value : sorted) {
      size_t at = 0;
      for (size_t d = index.size(); d-- > 0;) at = at * array_.shape[d] + index[d];
      value = array_.numbers[at];
      for (size_t d = index.size(); d-- > 0;) {
        if (++index[d] < array_.shape[d]) break;
        index[d] = 0;
      }
    }
    return sorted;
  }

  std::string file_;
  std::string_view contents_;
  ByteCursor data_;
  NpyArray array_;
  bool is_fortran_ = false;
  std::endian order_ = std::endian::little;
  char kind_ = 'f';
  size_t size_ = 8, width_ = 8;  // characters or bytes, and bytes, of a value
};

}  // namespace

NpyArray parse_npy(const std::string& file, std::string_view contents) { return NpyReader(file, contents).read(); }

}  // namespace aspic
