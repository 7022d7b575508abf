// Numbers as the shortest text that reads back to the same bits.
#pragma once
#include <string>

namespace aspic {

void append_number(double value, std::string& text);  // "0.1", "1e-09", "inf", "nan"
void append_number(float value, std::string& text);
std::string number_text(double value);

}  // namespace aspic
