// Seeds of the fuzzers.
#pragma once
#include <string>
#include <vector>

namespace aspic::fuzz {

struct Seed {
  std::string target, name, bytes;
};

std::vector<Seed> mesh_seeds();
std::vector<Seed> vtu_seeds();
std::vector<Seed> part_seeds();
std::vector<Seed> record_seeds();
std::vector<Seed> scene_seeds();
std::vector<Seed> viewer_seeds();

struct Dictionary {
  std::string target, text;  // input in the syntax of libFuzzer
};

std::vector<Dictionary> dictionaries();

}  // namespace aspic::fuzz
