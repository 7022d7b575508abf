#include "io/legacy_vtk_array.h"

#include <algorithm>
#include <cctype>
#include <type_traits>

#include "base/error.h"
#include "base/number_chars.h"

namespace aspic {
namespace {

constexpr std::string_view kArray = "a number of an array";

template <class Stored>
double real_of(ByteCursor& bytes) {
  return static_cast<double>(bytes.read<Stored>(kArray));
}

template <class Stored>
int64_t integer_of(ByteCursor& bytes) {
  return static_cast<int64_t>(bytes.read<Stored>(kArray));
}

template <class Stored>
constexpr LegacyVtkType integer_type(std::string_view name) {
  const FieldType field = sizeof(Stored) < 4 || std::is_same_v<Stored, int32_t> ? FieldType::int32 : FieldType::float64;
  return {name, sizeof(Stored), field, true, real_of<Stored>, integer_of<Stored>};
}

template <class Stored>
constexpr LegacyVtkType real_type(std::string_view name, FieldType field) {
  return {name, sizeof(Stored), field, false, real_of<Stored>, nullptr};
}

// VTK writes vtkIdType with 32 bits.
constexpr LegacyVtkType kTypes[] = {integer_type<int8_t>("char"),
                                    integer_type<int8_t>("signed_char"),
                                    integer_type<uint8_t>("unsigned_char"),
                                    integer_type<int16_t>("short"),
                                    integer_type<uint16_t>("unsigned_short"),
                                    integer_type<int32_t>("int"),
                                    integer_type<uint32_t>("unsigned_int"),
                                    integer_type<int64_t>("long"),
                                    integer_type<uint64_t>("unsigned_long"),
                                    integer_type<int32_t>("vtkidtype"),
                                    integer_type<int32_t>("vtktypeint32"),
                                    integer_type<uint32_t>("vtktypeuint32"),
                                    integer_type<int64_t>("vtktypeint64"),
                                    integer_type<uint64_t>("vtktypeuint64"),
                                    real_type<float>("float", FieldType::float32),
                                    real_type<double>("double", FieldType::float64),
                                    {"bit", 0, FieldType::int32, true, nullptr, nullptr},
                                    {"string", 0, FieldType::int32, true, nullptr, nullptr}};

const LegacyVtkType* type_named(std::string_view name) {
  const auto type = std::find_if(std::begin(kTypes), std::end(kTypes), [&](const auto& t) { return t.name == name; });
  return type == std::end(kTypes) ? nullptr : type;
}

int hex_digit(char c) {
  const char* const digits = "0123456789abcdef";
  const char lower = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const char* const place = std::find(digits, digits + 16, lower);
  return place == digits + 16 ? -1 : static_cast<int>(place - digits);
}

template <class Number>
Number from_text(TextScanner& text) {
  if constexpr (std::is_integral_v<Number>) {
    return text.integer(kArray);
  } else {  // fields may hold NaN
    const std::string_view word = text.word(kArray);
    if (const auto value = parse_number(word)) return *value;
    double value = 0;
    const auto [end, error] = from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size())
      text.fail(std::string(kArray) + " is " + shown(word) + "; it must be a number");
    return value;
  }
}

}  // namespace

std::string lower_case(std::string_view word) {
  std::string lower(word);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

const LegacyVtkType& legacy_vtk_int() { return *type_named("int"); }
const LegacyVtkType& legacy_vtk_color() { return *type_named("unsigned_char"); }

const LegacyVtkType& LegacyVtkSource::type() {
  const std::string_view word = text_.word("the type of an array");
  if (const LegacyVtkType* type = type_named(lower_case(word))) return *type;
  text_.fail("the type of an array is " + shown(word) + "; known are int, float, double and the other types of VTK");
}

std::string LegacyVtkSource::name() {
  const std::string_view word = text_.word("the name of an array");
  std::string name;
  for (size_t i = 0; i < word.size(); ++i) {
    const bool is_code =
        word[i] == '%' && i + 2 < word.size() && hex_digit(word[i + 1]) >= 0 && hex_digit(word[i + 2]) >= 0;
    name += is_code ? static_cast<char>(16 * hex_digit(word[i + 1]) + hex_digit(word[i + 2])) : word[i];
    if (is_code) i += 2;
  }
  return printable(name);
}

template <class Number>
std::vector<Number> LegacyVtkSource::numbers(const LegacyVtkType& type, int64_t count) {
  std::vector<Number> values;
  if (!is_binary_) {
    values.resize(static_cast<size_t>(text_.checked_count(count, "the number of values", 2)));
    for (Number& value : values) value = from_text<Number>(text_);
    return values;
  }
  text_.skip_line();
  ByteCursor bytes(text_.file(), text_.text(), text_.position(), std::endian::big);
  values.resize(static_cast<size_t>(bytes.checked_count(count, "the number of values", type.size)));
  for (Number& value : values) {
    if constexpr (std::is_integral_v<Number>)
      value = type.integer(bytes);
    else
      value = type.real(bytes);
  }
  text_.seek(bytes.position());
  return values;
}

std::vector<double> LegacyVtkSource::reals(const LegacyVtkType& type, int64_t count) {
  if (!type.real) text_.fail("an array of the type " + std::string(type.name) + " holds no numbers; leave it out");
  return numbers<double>(type, count);
}

std::vector<int64_t> LegacyVtkSource::integers(const LegacyVtkType& type, int64_t count) {
  if (!type.integer) text_.fail("the type is " + std::string(type.name) + "; integers are needed");
  return numbers<int64_t>(type, count);
}

// In binary, the two highest bits of the first byte of a text give the size of its length: 1, 2, 4 or 8 bytes.
void LegacyVtkSource::skip_texts(int64_t count) {
  text_.skip_line();
  if (!is_binary_) {
    for (int i = text_.checked_count(count, "the number of texts", 1); i > 0; --i) text_.skip_line();
    return;
  }
  ByteCursor bytes(text_.file(), text_.text(), text_.position(), std::endian::big);
  for (int i = bytes.checked_count(count, "the number of texts", 1); i > 0; --i) {
    const auto first = bytes.read<uint8_t>("the length of a text");
    uint64_t length = first & 63;
    for (int more = (1 << (3 - (first >> 6))) - 1; more > 0; --more)
      length = length << 8 | bytes.read<uint8_t>("the length of a text");
    bytes.skip(length, "a text");
  }
  text_.seek(bytes.position());
}

void LegacyVtkSource::skip_bits(int64_t count) {
  if (!is_binary_) {
    for (int i = text_.checked_count(count, "the number of bits", 2); i > 0; --i) text_.word("a bit");
    return;
  }
  text_.skip_line();
  ByteCursor bytes(text_.file(), text_.text(), text_.position());
  if (count < 0) bytes.fail("the number of bits is " + std::to_string(count) + "; it must not be negative");
  bytes.skip(static_cast<uint64_t>(count) / 8 + (count % 8 != 0), "bits");
  text_.seek(bytes.position());
}

}  // namespace aspic
