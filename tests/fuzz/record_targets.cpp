
#include "io/checkpoint.h"
#include "io/csv_reader.h"
#include "io/pc2.h"
#include "several_files.h"
#include "targets.h"

namespace aspic::fuzz {

namespace {

template <CsvOrigin origin>
void read_table(std::string_view bytes) {
  const auto path = folder_of_process() / "table.csv";
  put_file(path, bytes);
  CsvReader table(path, origin);
  while (table.next())
    for (size_t i = 0; i < table.columns().size(); ++i)
      if (table.is_blank(i) || !table.try_number(i)) table.text(i);
}

}  // namespace

void csv(std::string_view bytes) {
  attempt(read_table<CsvOrigin::aspic>, bytes);
  attempt(read_table<CsvOrigin::foreign>, bytes);
}

void checkpoint(std::string_view bytes) {
  const auto path = folder_of_process() / "checkpoint.bin";
  put_file(path, with_right_checksum(bytes));
  const Checkpoint read = read_checkpoint(path);
  size_t size = 0;
  for (const auto& [name, values] : read.arrays) size += name.size() + values.size() * sizeof(double);
  require(size <= bytes.size(), "arrays are no larger than their file");
}

void point_cache(std::string_view bytes) {
  const auto path = folder_of_process() / "skin.pc2";
  put_file(path, bytes);
  Pc2Reader cache(path);
  for (int i = 0; i < cache.samples() && i < 100; ++i)
    require(cache.sample(i).size() == 3 * static_cast<size_t>(cache.points()), "a sample has all points");
  Pc2File::resume(path, cache.points(), cache.samples() / 2);
}

}  // namespace aspic::fuzz
