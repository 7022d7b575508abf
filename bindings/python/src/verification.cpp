// Problems with known answers.
#include "verification/check.h"

#include <pybind11/stl.h>

#include "base/error.h"
#include "bindings.h"
#include "interpreter.h"

namespace aspic::python {
namespace {

py::list list_of(const verify::Findings& findings) {
  py::list rows;
  for (const verify::Row& row : findings.rows) {
    py::dict entry;
    entry["quantity"] = row.quantity;
    entry["measured"] = row.measured;
    entry["reference"] = row.reference;
    entry["tolerance"] = row.tolerance;
    entry["unit"] = row.unit;
    entry["reason"] = row.reason;
    entry["passed"] = row.passes();
    rows.append(entry);
  }
  return rows;
}

py::dict verify_named(const std::string& name, bool quick) {
  py::dict results;
  std::vector<std::string> known;
  for (const verify::Check& check : verify::checks()) {
    known.push_back(check.key());
    if (!name.empty() && check.key() != name && check.family != name) continue;
    verify::Findings findings;
    {
      const ReleasedGil free;
      findings = verify::run_check(check, {.quick = quick});
    }
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    results[py::str(check.key())] = list_of(findings);
  }
  if (results.empty()) throw InvalidInput("there is no check '" + name + "'" + suggestion(name, known));
  return results;
}

}  // namespace

void bind_verification(py::module_& m) {
  m.def("verify", &verify_named, py::arg("name") = "", py::arg("quick") = true,
        "Runs checks with known answers: a family, one check, or all. Returns {check: [rows]}.");
}

}  // namespace aspic::python
