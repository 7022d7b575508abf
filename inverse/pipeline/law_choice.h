// Comparison of strain energy densities by what they predict, and the choice of one of them.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "estimate/predictive_probability.h"
#include "estimate/uncertainty.h"

namespace aspic {

// A fitted value of one law.
struct LawValue {
  std::string quantity, unit, where;
  double value = 0;                  // [SI]
  std::optional<Interval> interval;  // 95 % interval; empty: unknown
};

// Fit of one law. Squares are those of the residuals in standard deviations.
struct LawTrial {
  std::string law;
  std::string failure;  // why there is no fit; empty if there is one
  std::vector<LawValue> values;
  int parameters = 0;  // number of fitted values
  int residuals = 0;
  double squares = 0;                            // |r|^2
  double roughness = 0;                          // R of the prior
  std::vector<double> information;               // eigenvalues d of J'J relative to the prior
  double position_error = -1, force_error = -1;  // held out, see PredictionErrors; < 0: none
  std::vector<PredictiveResiduals> held_out;     // of each held-out group; empty: none
  double evidence_loss = 0;                      // log evidence of the best law minus that of this one
  double held_out_loss = 0;                      // the same for the log probability of all held-out groups
  std::string against;                           // why the verdict of its material is bad; empty: good, or not judged
  bool is_as_good = false;                       // not distinguished from the best law
  std::string verdict;                           // "chosen", "as good, but with 2 more values", ...

  bool is_fitted() const { return failure.empty(); }
  bool is_supported() const { return is_fitted() && against.empty(); }
};

struct LawChoice {
  std::vector<LawTrial> trials;
  int chosen = -1;  // index of a trial; < 0: none
  double noise_factor =
      1;                   // common factor of the standard deviations, from the best law; > 1: no law explains the data
  double strain = 0;       // 95 % of the body stay below this stretch in all cases: largest |stretch - 1|
  std::string simplified;  // parameterization that replaced a field for the comparison; empty: none
  std::string text;        // conclusion, in sentences

  bool has_supported() const;  // a law that can be fitted and has no bad verdict
};

inline constexpr char kAutoLaw[] = "auto";

// Computes the losses and verdicts of the trials and chooses a law by the rule of inverse/docs/fitting.md. A law with a
// bad verdict is chosen only if no law has a good one.
void judge_laws(LawChoice& choice);

}  // namespace aspic
