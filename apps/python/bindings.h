/// Functions and types that all parts of the Python module share.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <exception>
#include <string>
#include <utility>
#include <vector>

#include "awmr/core/name_table.h"
#include "awmr/core/provenance.h"
#include "awmr/core/result.h"
#include "awmr/model/vehicle.h"
#include "awmr/trials/trial_data.h"

namespace awmr::python {

namespace py = pybind11;

/// C++ exception with an Error of the library; errors.cpp converts it to a Python exception.
class Raised : public std::exception {
 public:
  explicit Raised(Error error) : error_(std::move(error)) {}
  const char* what() const noexcept override { return "an error of awmr"; }
  const Error& error() const { return error_; }

 private:
  Error error_;
};

/// Returns the value or raises the error.
template <class T>
T value_or_raise(Result<T> result) {
  if (!result) throw Raised(std::move(result).error());
  if constexpr (!std::is_void_v<T>) return std::move(*result);
}

/// Returns the value with a given name. `what`: the Python argument that has the name. Raises
/// InputError for an unknown name; the message lists the known names.
template <class Value, std::size_t N>
Value value_of(const NameTable<Value, N>& names, const std::string& name, const char* what) {
  if (const auto value = value_in(names, name)) return *value;
  std::string known;
  for (const auto& one : names_in(names)) known += " " + std::string(one);
  throw Raised(
      input_error(ErrorCode::kUnknownName, what, "'" + name + "' is not one of" + known).value());
}

/// Copies the numbers into a one-dimensional NumPy array.
template <class T>
py::array_t<T> to_array(const std::vector<T>& values) {
  return py::array_t<T>(static_cast<py::ssize_t>(values.size()), values.data());
}

/// Returns one field of all rows as a NumPy array.
template <class Row, class Member>
py::array to_column(const std::vector<Row>& rows, Member member) {
  using T = decltype(member(rows.front()));
  std::vector<T> values;
  values.reserve(rows.size());
  for (const Row& row : rows) values.push_back(member(row));
  return to_array(values);
}

/// Defines the Python function module.read_NAME(path), which raises InputError if reading fails.
/// `read`: the function read_NAME of the C++ library.
template <class Read>
void bind_read(py::module_& module, const char* name, Read read, const char* text) {
  module.def(
      name, [read](const std::filesystem::path& path) { return value_or_raise(read(path)); },
      py::arg("path"), text);
}

/// A vehicle with the file from which it was read. A model that is identified for this vehicle
/// records name and hash of this file.
struct VehicleOfFile : Vehicle {
  InputFile file;
};

/// Trials, their files, and the options with which the files were read.
struct TrialsOfFiles : Trials {
  std::vector<InputFile> inputs = {};
  NamedOptions reading = {};  ///< options as text
  bool as_is = false;
};

void bind_errors(py::module_& module);
void bind_model(py::module_& module);
void bind_trials(py::module_& module);
void bind_identify(py::module_& module);
void bind_tune(py::module_& module);
void bind_simulate(py::module_& module);
void bind_compare(py::module_& module);

}  // namespace awmr::python
