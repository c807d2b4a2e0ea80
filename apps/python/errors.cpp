#include "awmr/core/option_text.h"
#include "bindings.h"

namespace awmr::python {
namespace {

/// The exception classes, which live as long as the module.
struct Classes {
  py::object base;
  py::object input;
  py::object refused;
  py::object fault;

  const py::object& of(ErrorKind kind) const {
    return kind == ErrorKind::kInput ? input : kind == ErrorKind::kRefused ? refused : fault;
  }
};

py::object new_class(py::module_& module, const char* name, const char* doc, py::handle base) {
  const std::string full = "awmr." + std::string(name);
  auto made = py::reinterpret_steal<py::object>(
      PyErr_NewExceptionWithDoc(full.c_str(), doc, base.ptr(), nullptr));
  module.attr(name) = made;
  return made;
}

void raise(const Error& error, const Classes& classes) {
  std::string text;
  py::list faults, codes;
  for (const Fault& fault : error.faults) {
    text += (text.empty() ? "" : "\n") + to_text(fault, "--");
    codes.append(std::string(name_in(kErrorCodeNames, fault.code)));
    faults.append(
        py::make_tuple(spell_options(fault.place, "--"), spell_options(fault.message, "--")));
  }
  const py::object& type = classes.of(error.kind);
  const py::object raised = type(text);
  raised.attr("faults") = faults;
  raised.attr("codes") = codes;
  raised.attr("exit_code") = exit_code(error);
  PyErr_SetObject(type.ptr(), raised.ptr());
}

}  // namespace

void bind_errors(py::module_& module) {
  static Classes* classes = nullptr;  // never destroyed: Python may outlive static objects
  classes = new Classes;
  classes->base = new_class(
      module, "Error",
      "An error, with the messages of the command line: one line per fault. `faults` is a list of "
      "(place, message); the place is FILE:LINE:COLUMN, FILE:/json/pointer, an option or empty. "
      "`codes` has the code of each fault (awmr explain CODE prints its meaning), `exit_code` the "
      "exit code with which the command line would end.",
      PyExc_Exception);
  classes->input =
      new_class(module, "InputError", "A file or a value is wrong (exit code 2).", classes->base);
  classes->refused = new_class(module, "Refused",
                               "The function ran, but has no result (exit code 1).", classes->base);
  classes->fault = new_class(module, "ProgramFault", "A fault of the library itself (exit code 3).",
                             classes->base);
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Raised& raised) {
      raise(raised.error(), *classes);
    }
  });
}

}  // namespace awmr::python
