// Bit-reproducible resumption of a fit. Stores its evaluations of the model; a resumed fit repeats them and gets the
// stored results without solving, until it reaches the interruption.
#pragma once
#include <filesystem>
#include <fstream>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "io/output_file.h"
#include "model/least_squares.h"

namespace aspic {

// Model state of the next evaluation besides p: equilibria.
struct ModelState {
  std::function<std::vector<double>()> get;
  std::function<void(std::span<const double>)> set;
};

enum class JournalStart {
  anew,
  resume,
  read,  // as resume, but changes no file: another process may read them, too
};

class Journal : public LeastSquares {
 public:
  // Writes `stem`.journal and, at every linearization, `stem`.state; both depend on `fingerprint`. Stores a reference
  // to `model`. Throws InvalidInput if it cannot resume from the files.
  Journal(LeastSquares& model, ModelState state, std::filesystem::path stem, const std::string& fingerprint,
          JournalStart start);

  int parameter_count() const override { return model_.parameter_count(); }
  int residual_count() const override { return model_.residual_count(); }
  int reading_count() const override { return model_.reading_count(); }
  bool evaluate(std::span<const double> p, std::span<double> r) override;
  bool linearize() override;
  void multiply(std::span<const double> dp, std::span<double> dr) override;
  void multiply_transposed(std::span<const double> w, std::span<double> pbar) override;
  int nuisance_count() const override { return model_.nuisance_count(); }
  NuisancePrior nuisance_prior(int k) const override { return model_.nuisance_prior(k); }
  void nuisance(int k, std::span<double> dr) override;
  std::vector<std::pair<int, int>> residuals_by_case() const override { return model_.residuals_by_case(); }

  bool is_replaying() const { return position_ < end_; }
  // Stops writing: later evaluations are not part of the fit.
  void stop_writing();
  // Restores the model to the last linearization if that was replayed.
  void catch_up();

  static void remove(const std::filesystem::path& stem);

 private:
  enum class Kind : unsigned char { evaluate, linearize, multiply, multiply_transposed, nuisance };
  struct Head;

  bool answer(Kind kind, std::span<const double> question, std::span<double> answer, const std::function<bool()>& ask);
  bool replayed(const Head& asked, std::span<double> answer);
  void write(Head head, std::span<const double> answer);
  void save_state();

  LeastSquares& model_;
  ModelState state_;
  std::filesystem::path journal_path_, state_path_;
  std::string fingerprint_;
  OutputFile out_;
  std::ifstream in_;
  std::uint64_t position_ = 0, end_ = 0;  // position and end of the replayed part [bytes]
  std::vector<double> p_;                 // p of the last successful evaluation
  std::vector<double> resumed_p_, resumed_state_;
  bool is_behind_ = false;  // the model has not yet been restored to the replayed state
};

}  // namespace aspic
