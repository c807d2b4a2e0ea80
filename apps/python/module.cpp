/// Python module `awmr`: functions of the library, under the library's names.
#include "awmr/core/provenance.h"
#include "bindings.h"

PYBIND11_MODULE(awmr, module) {
  module.doc() =
      "From trials to gains: read_vehicle, load_trials, identify, tune, simulate, compare.\n"
      "\n"
      "Names end in the unit: _m, _s, _rad, _deg, _mps, _radps, _kg. Forces are divided by F_max, "
      "the largest force of one motor. Angles and yaw rates are positive counter-clockwise, "
      "lateral quantities to the left. Tables are dicts of NumPy arrays. Warnings are in the list "
      "`findings` of a result; failures raise Error.";
  module.attr("__version__") = awmr::version();
  awmr::python::bind_errors(module);
  awmr::python::bind_model(module);
  awmr::python::bind_trials(module);
  awmr::python::bind_identify(module);
  awmr::python::bind_simulate(module);
  awmr::python::bind_tune(module);
  awmr::python::bind_compare(module);
}
