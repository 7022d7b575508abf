// Measurements of the programs in this folder as a table, one number per row.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace aspic::bench {

class Results {
 public:
  explicit Results(std::string bench) : bench_(std::move(bench)) {}

  void begin(std::string what, int threads) { what_ = std::move(what), threads_ = threads; }
  void add(const std::string& quantity, double value, const std::string& unit);
  // Columns bench, case, threads, quantity, value, unit. Rows of bench "machine" describe the machine.
  void write(const std::filesystem::path& path) const;  // an empty path writes nothing

 private:
  struct Row {
    std::string what;
    int threads;
    std::string quantity;
    double value;
    std::string unit;
  };
  std::string bench_, what_;
  int threads_ = 1;
  std::vector<Row> rows_;
};

}  // namespace aspic::bench
