#include "io/number_text.h"

#include <charconv>
#include <cmath>

namespace aspic {
namespace {

template <class Real>
void append_shortest(Real value, std::string& text) {
  if (std::isnan(value)) {  // without a sign, which would differ between machines
    text += "nan";
    return;
  }
  char buffer[40];
  text.append(buffer, std::to_chars(buffer, buffer + sizeof(buffer), value).ptr);
}

}  // namespace

void append_number(double value, std::string& text) { append_shortest(value, text); }
void append_number(float value, std::string& text) { append_shortest(value, text); }

std::string number_text(double value) {
  std::string text;
  append_number(value, text);
  return text;
}

}  // namespace aspic
