#include "bench/results.h"

#include "base/formatted.h"
#include "bench/machine.h"
#include "io/csv.h"

namespace aspic::bench {
namespace {

std::string four_digits(double value) { return formatted("%.4g", value); }  // more digits are noise

}  // namespace

void Results::add(const std::string& quantity, double value, const std::string& unit) {
  rows_.push_back({what_, threads_, quantity, value, unit});
}

void Results::write(const std::filesystem::path& path) const {
  if (path.empty()) return;
  CsvFile file = CsvFile::create(path, {"bench", "case", "threads", "quantity", "value", "unit"});
  for (const Fact& fact : machine_facts()) {
    file.append(CsvRow().add("machine").add("").add(0).add(fact.name).add(fact.value).add(""));
  }
  for (const Row& row : rows_) {
    file.append(CsvRow()
                    .add(bench_)
                    .add(row.what)
                    .add(row.threads)
                    .add(row.quantity)
                    .add(four_digits(row.value))
                    .add(row.unit));
  }
  file.close();
}

}  // namespace aspic::bench
