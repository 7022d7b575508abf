#include "dynamics/term_rows.h"

namespace aspic {

TermRows::TermRows(const StepTerms& terms, const Pins& pins) : terms_(terms), pins_(pins) {
  for (size_t k = 0; k < terms.potential().size(); ++k) {
    const Energy* V = &terms.potential()[k].energy();
    if (const auto* stiff = dynamic_cast<const StiffEnergy*>(V)) stiff_.emplace_back(stiff, k);
    if (const auto* dense = dynamic_cast<const DenseEnergy*>(V)) dense_.emplace_back(dense, k);
  }
}

void TermRows::evaluate(std::span<const double> q, double factor) {
  stiff_rows_.clear();
  for (const auto& [stiff, k] : stiff_) stiff->add_stiff_rows(q, factor, stiff_rows_);
  for (StiffRow& row : stiff_rows_)
    for (size_t n = 0; n < row.vertex.size(); ++n) row.g[n] = pins_.free_part(row.vertex[n], row.g[n]);
  dense_rows_.clear();
  for (const auto& [dense, k] : dense_) dense->add_dense_rows(q, terms_.potential()[k].context(), factor, dense_rows_);
  for (DenseRow& row : dense_rows_) pins_.set_zero(row.g);
}

}  // namespace aspic
