#include "to_table.h"

#include "arrays.h"
#include "base/error.h"

namespace aspic::python {
namespace {

constexpr int kDeepest = 32;

Place place_named(const std::string& where) { return {std::make_shared<const std::string>(where), 0, 0}; }

// "body.jelly" of a table with a name, else "body.0".
std::string name_of(const py::handle& element, size_t index) {
  if (py::isinstance<py::dict>(element)) {
    const py::dict table = py::reinterpret_borrow<py::dict>(element);
    if (table.contains("name") && py::isinstance<py::str>(table["name"])) return table["name"].cast<std::string>();
  }
  return std::to_string(index);
}

class Converter {
 public:
  Value convert(const py::handle& value, const std::string& where) {
    if (++depth_ > kDeepest) throw InvalidInput(where + ": more than " + std::to_string(kDeepest) + " levels");
    Value result{{}, place_named(where)};
    if (py::isinstance<py::dict>(value)) {
      result.data = table_of(py::reinterpret_borrow<py::dict>(value), where);
    } else if (!fill_scalar(value, where, result)) {
      result.data = array_of(value, where);
    }
    --depth_;
    return result;
  }

 private:
  Table table_of(const py::dict& dict, const std::string& where) {
    Table table;
    for (const auto& [key, value] : dict) {
      if (!py::isinstance<py::str>(key)) throw InvalidInput(where + ": keys must be strings");
      if (value.is_none()) continue;
      const auto name = key.cast<std::string>();
      const std::string path = where + "." + name;
      table.members.push_back({name, place_named(path), convert(value, path)});
    }
    return table;
  }

  static bool fill_scalar(const py::handle& value, const std::string& where, Value& result) {
    PyObject* object = value.ptr();
    if (py::isinstance<py::str>(value)) {
      result.data = value.cast<std::string>();
    } else if (PyBool_Check(object) || py::isinstance(value, py::module_::import("numpy").attr("bool_"))) {
      result.data = PyObject_IsTrue(object) == 1;
    } else if (PyIndex_Check(object) && !py::isinstance<py::array>(value)) {
      const py::object number = py::reinterpret_steal<py::object>(PyNumber_Index(object));
      int overflow = 0;
      const std::int64_t integer = number ? PyLong_AsLongLongAndOverflow(number.ptr(), &overflow) : 0;
      if (!number) throw py::error_already_set();
      if (overflow != 0) throw InvalidInput(where + ": this integer is too large");
      result.data = integer;
    } else if (PyFloat_Check(object)) {
      result.data = PyFloat_AsDouble(object);
    } else if (py::isinstance(value, py::module_::import("numpy").attr("floating"))) {
      result.data = value.attr("__float__")().cast<double>();
    } else if (py::hasattr(value, "__fspath__")) {
      result.data = value.attr("__fspath__")().cast<std::string>();
    } else {
      return false;
    }
    return true;
  }

  aspic::Array array_of(const py::handle& value, const std::string& where) {
    py::object list = py::reinterpret_borrow<py::object>(value);
    if (py::isinstance<py::array>(value)) {
      require_bounded(py::reinterpret_borrow<py::array>(value), where);
      list = value.attr("tolist")();
    }
    if (!py::isinstance<py::list>(list) && !py::isinstance<py::tuple>(list))
      throw InvalidInput(where + ": this is " + std::string(py::str(py::type::of(value).attr("__name__"))) +
                         "; expected a number, a string, a list or a dict");
    aspic::Array array;
    for (const auto element : list) array.push_back(convert(element, where + "." + name_of(element, array.size())));
    return array;
  }

  int depth_ = 0;
};

}  // namespace

Value to_value(const py::handle& value, const std::string& where) { return Converter().convert(value, where); }

}  // namespace aspic::python
