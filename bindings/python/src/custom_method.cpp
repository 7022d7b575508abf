#include "custom_method.h"

#include <algorithm>

#include "base/error.h"

namespace aspic::python {
namespace {

// A function that the library may copy and destroy without the GIL.
std::shared_ptr<py::object> shared(const py::object& f, const char* usage) {
  if (!PyCallable_Check(f.ptr())) throw InvalidInput(std::string(usage) + ": must be callable");
  return {new py::object(f), [](py::object* owned) {
            const HeldGil lock;
            delete owned;
          }};
}

std::shared_ptr<Function> function_of(Objective& E, const MethodContext& context) {
  return std::make_shared<Function>(&E, context.layout, context.callbacks);
}

class PythonDirection : public SearchDirection {
 public:
  PythonDirection(std::shared_ptr<py::object> compute, MethodContext context)
      : compute_(std::move(compute)), context_(std::move(context)) {}

  std::string_view name() const override { return "python"; }
  bool compute(const Iterate& at, std::span<double> d, DirectionReport&) override {
    const Layout& layout = context_.layout;
    return context_.callbacks->call([&] {
      const Lent E(function_of(at.E, context_));
      const std::vector<double> found =
          layout.in((*compute_)(*E, layout.out(at.x), layout.out(at.g)), "the search direction");
      std::copy(found.begin(), found.end(), d.begin());
      if (context_.set_pins_zero) context_.set_pins_zero(d);
    });
  }

 private:
  std::shared_ptr<py::object> compute_;
  MethodContext context_;
};

}  // namespace

std::unique_ptr<SearchDirection> make_python_direction(const py::object& compute, MethodContext context) {
  return std::make_unique<PythonDirection>(shared(compute, "direction(E, x, g)"), std::move(context));
}

std::function<double(const SearchLine&)> make_python_line_search(const py::object& search, MethodContext context) {
  if (search.is_none()) return {};
  return [search = shared(search, "line_search(E, x, d, g)"), context = std::move(context)](const SearchLine& line) {
    double alpha = 0;
    context.callbacks->call([&] {
      const Layout& layout = context.layout;
      const Lent E(function_of(line.E, context));
      const py::object found = (*search)(*E, layout.out(line.x), layout.out(line.d), layout.out(line.g));
      alpha = *reals(found, "the step length of the line search", {}).data();
    });
    return alpha;
  };
}

}  // namespace aspic::python
