#include "pipeline/journal.h"

#include <cstring>

#include "base/check.h"
#include "base/error.h"
#include "io/checkpoint.h"
#include "io/input_file.h"
#include "scene/scene_files.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;

fs::path with_ending(const fs::path& stem, const char* ending) {
  fs::path path = stem;
  path += ending;
  return path;
}

const char* const kRemedy = "; restart with --force";

}  // namespace

// Header of an answer.
struct Journal::Head {
  std::uint64_t question = 0;  // hash of the question
  std::uint32_t count = 0;     // number of values in the answer
  Kind kind = Kind::evaluate;
  unsigned char ok = 0;
  unsigned char padding[2] = {};
};

Journal::Journal(LeastSquares& model, ModelState state, fs::path stem, const std::string& fingerprint,
                 JournalStart start)
    : model_(model),
      state_(std::move(state)),
      journal_path_(with_ending(stem, ".journal")),
      state_path_(with_ending(stem, ".state")),
      fingerprint_(fingerprint) {
  const bool can_resume = start != JournalStart::anew && fs::exists(state_path_) && fs::exists(journal_path_);
  if (!can_resume) {
    if (start == JournalStart::read) return;
    remove(stem);
    out_ = OutputFile::create(journal_path_);
    return;
  }
  const Checkpoint saved = read_newest_checkpoint(state_path_).checkpoint;
  if (saved.fingerprint != fingerprint)
    throw InvalidInput(state_path_.string() + ": belongs to another fit (other data or options)" + kRemedy);
  end_ = static_cast<std::uint64_t>(saved.integer("journal_bytes"));
  if (const std::uintmax_t size = fs::file_size(journal_path_); size < end_)
    throw InvalidInput(journal_path_.string() + ": has " + std::to_string(size) + " bytes where " +
                       std::to_string(end_) + " are needed" + kRemedy);
  if (start == JournalStart::resume) {
    out_ = OutputFile::open_existing(journal_path_);
    out_.truncate(end_);
  }
  in_ = open_input(journal_path_);
  resumed_p_ = saved.array("p");
  resumed_state_ = saved.array("state");
  is_behind_ = end_ > 0;
}

bool Journal::evaluate(std::span<const double> p, std::span<double> r) {
  const bool ok = answer(Kind::evaluate, p, r, [&] { return model_.evaluate(p, r); });
  if (ok) p_.assign(p.begin(), p.end());
  return ok;
}

bool Journal::linearize() {
  const bool ok = answer(Kind::linearize, p_, {}, [&] { return model_.linearize(); });
  if (ok && !is_replaying() && !is_behind_ && out_.is_open()) save_state();
  return ok;
}

void Journal::multiply(std::span<const double> dp, std::span<double> dr) {
  answer(Kind::multiply, dp, dr, [&] { return model_.multiply(dp, dr), true; });
}

void Journal::multiply_transposed(std::span<const double> w, std::span<double> pbar) {
  answer(Kind::multiply_transposed, w, pbar, [&] { return model_.multiply_transposed(w, pbar), true; });
}

void Journal::nuisance(int k, std::span<double> dr) {
  const double number = k;
  answer(Kind::nuisance, {&number, 1}, dr, [&] { return model_.nuisance(k, dr), true; });
}

void Journal::stop_writing() { out_.close(); }

void Journal::remove(const fs::path& stem) {
  std::error_code ignored;
  for (const char* ending : {".journal", ".state"}) fs::remove(with_ending(stem, ending), ignored);
  fs::remove(previous_checkpoint(with_ending(stem, ".state")), ignored);
}

bool Journal::answer(Kind kind, std::span<const double> question, std::span<double> answer,
                     const std::function<bool()>& ask) {
  Fingerprint hash;
  hash.add(question.data(), question.size_bytes());
  Head head{.question = hash.value(), .count = static_cast<std::uint32_t>(answer.size()), .kind = kind};
  if (is_replaying()) return replayed(head, answer);
  catch_up();
  head.ok = ask() ? 1 : 0;
  write(head, answer);
  return head.ok != 0;
}

bool Journal::replayed(const Head& asked, std::span<double> answer) {
  Head head;
  in_.read(reinterpret_cast<char*>(&head), sizeof head);
  const bool is_same = in_ && head.question == asked.question && head.kind == asked.kind && head.count == asked.count;
  if (is_same && head.ok)
    in_.read(reinterpret_cast<char*>(answer.data()), static_cast<std::streamsize>(answer.size_bytes()));
  if (!is_same || !in_)
    throw InvalidInput(journal_path_.string() + ": this program differs from the one that wrote it" + kRemedy);
  position_ += sizeof head + (head.ok ? answer.size_bytes() : 0);
  return head.ok != 0;
}

void Journal::write(Head head, std::span<const double> answer) {
  if (!out_.is_open()) return;
  std::string bytes(sizeof head + (head.ok ? answer.size_bytes() : 0), '\0');
  std::memcpy(bytes.data(), &head, sizeof head);
  if (head.ok && !answer.empty()) std::memcpy(bytes.data() + sizeof head, answer.data(), answer.size_bytes());
  out_.append(bytes);
}

// Writes the journal first, so that the state never refers to missing entries.
void Journal::save_state() {
  out_.sync();
  write_checkpoint(state_path_, {.fingerprint = fingerprint_,
                                 .arrays = {{"p", p_}, {"state", state_.get()}},
                                 .integers = {{"journal_bytes", static_cast<std::int64_t>(out_.size())}}});
}

// The last replayed entry is a linearization. From the state there, the model finds the same equilibria and matrices
// again.
void Journal::catch_up() {
  if (!is_behind_) return;
  is_behind_ = false;
  in_.close();
  state_.set(resumed_state_);
  std::vector<double> r(static_cast<size_t>(model_.residual_count()));
  if (!model_.evaluate(resumed_p_, r) || !model_.linearize())
    throw InvalidInput(state_path_.string() + ": the model cannot be evaluated at the stored state" + kRemedy);
}

}  // namespace aspic
