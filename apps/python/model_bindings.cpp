#include <fmt/format.h>

#include <optional>

#include "awmr/core/input_file.h"
#include "awmr/model/gains_file.h"
#include "awmr/model/model_file.h"
#include "awmr/model/ranges.h"
#include "awmr/model/vehicle_file.h"
#include "bindings.h"

namespace awmr::python {
namespace {

ParameterId parameter_of(const std::string& name) {
  if (const auto id = parameter_by_name(name)) return *id;
  throw py::key_error(name);
}

py::object interval_of(const std::optional<Interval>& interval) {
  if (!interval) return py::none();
  return py::make_tuple(interval->lo, interval->hi);
}

void bind_findings(py::module_& module) {
  py::class_<Finding>(module, "Finding",
                      "A message about the data or the result: `severity` is \"note\", "
                      "\"warning\" or \"error\"; `code` does not change between versions; `line` "
                      "is the line of `file`, 0 if the message does not refer to a line.")
      .def_readonly("file", &Finding::file)
      .def_readonly("line", &Finding::line)
      .def_readonly("code", &Finding::code)
      .def_readonly("message", &Finding::message)
      .def_property_readonly(
          "severity",
          [](const Finding& finding) { return name_in(kSeverityNames, finding.severity); })
      .def("__repr__", [](const Finding& finding) {
        return fmt::format("<Finding {} {}:{}: {}>", finding.code, finding.file, finding.line,
                           finding.message);
      });
}

Result<VehicleOfFile> read_with_its_file(const std::filesystem::path& path) {
  AWMR_ASSIGN_OR_RETURN(Vehicle vehicle, read_vehicle(path));
  AWMR_ASSIGN_OR_RETURN(InputFile file, input_file(path));
  return VehicleOfFile{std::move(vehicle), std::move(file)};
}

void bind_vehicle(py::module_& module) {
  py::class_<Vehicle>(module, "Vehicle",
                      "The vehicle's data that are known before any trial (vehicle.json).")
      .def_readonly("name", &Vehicle::name)
      .def_readonly("mass_kg", &Vehicle::mass_kg, "mass of the vehicle, ready to drive, kg")
      .def_readonly("length_m", &Vehicle::length_m, "length of the body (forward axis x), m")
      .def_readonly("width_m", &Vehicle::width_m, "width of the body (lateral axis y), m")
      .def_readonly("front_axle_m", &Vehicle::front_axle_m,
                    "l_f, distance from the centre of gravity to the front axle, m")
      .def_readonly("half_track_m", &Vehicle::half_track_m,
                    "d, distance from the centre line to the middle of a wheel, m")
      .def_readonly("steering_max_deg", &Vehicle::steering_max_deg,
                    "largest steering angle to either side, deg; 0 without steering")
      .def_readonly("steering_max_rate_degps", &Vehicle::steering_max_rate_degps,
                    "largest rate of the steering servo, deg/s; 0 without steering")
      .def_readonly(
          "steering_time_constant_s", &Vehicle::steering_time_constant_s,
          "T, time constant of the steering servo (first-order lag), s; 0 without steering")
      .def_readonly("sample_time_s", &Vehicle::sample_time_s,
                    "T_s, time between two steps of the controller, s")
      .def_property_readonly(
          "wheel_force",
          [](const Vehicle& v) { return py::make_tuple(v.wheel_force.lo, v.wheel_force.hi); },
          "(smallest, largest) force of one wheel, divided by F_max; the smallest is negative if "
          "the motors can reverse")
      .def_property_readonly("drive",
                             [](const Vehicle& v) { return name_in(kDriveNames, v.drive); })
      .def_property_readonly("inertia_kgm2", &Vehicle::inertia_kgm2,
                             "Iz, kg m^2: the measured yaw inertia, else that of a uniform box");
  py::class_<VehicleOfFile, Vehicle>(module, "VehicleOfFile",
                                     "A vehicle that read_vehicle() returned. A model identified "
                                     "for it records the name and hash of its file.");
  bind_read(module, "read_vehicle", read_with_its_file, "Reads a vehicle.json. Raises InputError.");
}

void bind_estimate(py::module_& module) {
  py::class_<Estimate>(
      module, "Estimate",
      "One identified number. `value` is None if the data do not determine it; `std_error` and "
      "`ci95` (lo, hi) are None if its uncertainty is not known. All are in the parameter's unit "
      "(`awmr.units`).")
      .def_readonly("value", &Estimate::value)
      .def_readonly("std_error", &Estimate::std_error)
      .def_property_readonly("ci95", [](const Estimate& e) { return interval_of(e.ci95); })
      .def_property_readonly("source",
                             [](const Estimate& e) { return name_in(kSourceNames, e.source); })
      .def_readonly("method", &Estimate::method)
      .def("__repr__", [](const Estimate& e) {
        return e.value ? fmt::format("<Estimate {} ({})>", *e.value, e.method)
                       : std::string("<Estimate unknown>");
      });
}

py::tuple covariance_of(const Model& model) {
  py::list names;
  for (const ParameterId id : model.covariance.parameters) names.append(info(id).name);
  const auto size = static_cast<py::ssize_t>(model.covariance.parameters.size());
  py::array_t<double> matrix({size, size});
  auto cells = matrix.mutable_unchecked<2>();
  for (py::ssize_t i = 0; i < size; ++i) {
    for (py::ssize_t j = 0; j < size; ++j) {
      cells(i, j) =
          model.covariance.matrix[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
    }
  }
  return py::make_tuple(names, matrix);
}

py::list names_of(const Model& model) {
  py::list names;
  for (const ParameterInfo& parameter : parameter_table()) {
    if (is_absent_term(model, parameter.id) || !has(model.vehicle, parameter.id)) continue;
    names.append(parameter.name);
  }
  return names;
}

void bind_model_class(py::module_& module) {
  py::class_<Model>(module, "Model",
                    "The identified model of a vehicle. model[\"surge.alpha\"] is the Estimate of "
                    "that parameter, model.keys() are the parameters' names.")
      .def("__getitem__",
           [](const Model& model, const std::string& name) { return model[parameter_of(name)]; })
      .def("keys", names_of, "the parameters that this model has")
      .def("__iter__", [](const Model& model) { return py::iter(names_of(model)); })
      .def("__len__", [](const Model& model) { return py::len(names_of(model)); })
      .def_readonly("vehicle", &Model::vehicle)
      .def_property_readonly("surge_family", [](const Model& m) { return name_of(m.surge_family); })
      .def_property_readonly("yaw_family", [](const Model& m) { return name_of(m.yaw_family); })
      .def_property_readonly(
          "covariance", covariance_of,
          "(names, covariance matrix) of the fitted parameters; an element has the product of "
          "the units of its two parameters")
      .def_property_readonly("findings", [](const Model& m) { return m.record.findings; })
      .def("text", model_text, "the bytes of model.json");
  bind_read(
      module, "read_model", [](const auto& path) { return read_model(path); },
      "Reads a model.json. Raises InputError.");
  module.def(
      "write_model",
      [](const Model& model, const std::filesystem::path& path) {
        value_or_raise(write_model(model, path));
      },
      py::arg("model"), py::arg("path"),
      "Writes model.json, completely or not at all. Raises InputError.");
}

void check_friction_width(const char* name, double radps) {
  if (allows(kFrictionWidth_radps, radps)) return;
  throw Raised(
      input_error(ErrorCode::kOutOfRange, name,
                  fmt::format("expected {}, found {}", describe(kFrictionWidth_radps), radps))
          .value());
}

Gains<double> gains_from(double lambda, double mu, double epsilon, double speed_mu,
                         double speed_epsilon, double friction_width_radps,
                         std::optional<double> combined_friction_width_radps,
                         double bandwidth_radps, double yaw_max_m, double surge_max) {
  for (const double gain : {lambda, mu, epsilon, speed_mu, speed_epsilon}) {
    if (gain > 0.0 && gain < 1e9) continue;
    throw Raised(input_error(ErrorCode::kOutOfRange, "gains",
                             fmt::format("expected numbers above 0, found {}", gain))
                     .value());
  }
  check_friction_width("friction_width_radps", friction_width_radps);
  if (combined_friction_width_radps) {
    check_friction_width("combined_friction_width_radps", *combined_friction_width_radps);
  }
  const ObserverGains<double> observer{bandwidth_radps, yaw_max_m, surge_max};
  for (const double one : {bandwidth_radps, yaw_max_m, surge_max}) {
    if (one >= 0.0 && one < 1e9 && (one > 0.0) == observer.is_on()) continue;
    throw Raised(input_error(ErrorCode::kOutOfRange, "gains",
                             "expected observer_bandwidth_radps, observer_yaw_max_m and "
                             "observer_surge_max all above 0, or all 0")
                     .value());
  }
  return {{lambda, mu, epsilon, friction_width_radps, combined_friction_width_radps.value_or(0.0)},
          {speed_mu, speed_epsilon},
          observer};
}

void bind_gain_values(py::class_<Gains<double>>& gains) {
  using G = Gains<double>;
  gains
      .def_property_readonly(
          "lambda_", [](const G& g) { return g.heading.lambda; }, "1/s")
      .def_property_readonly(
          "mu", [](const G& g) { return g.heading.mu; }, "rad/s^2")
      .def_property_readonly(
          "epsilon", [](const G& g) { return g.heading.epsilon; }, "rad/s")
      .def_property_readonly(
          "friction_width_radps", [](const G& g) { return g.heading.friction_width_radps; },
          "rad/s")
      .def_property_readonly(
          "combined_friction_width_radps", [](const G& g) { return g.friction_width_at(0.5); },
          "rad/s")
      .def_property_readonly(
          "speed_mu", [](const G& g) { return g.speed.mu; }, "m/s^2")
      .def_property_readonly(
          "speed_epsilon", [](const G& g) { return g.speed.epsilon; }, "m/s")
      .def_property_readonly(
          "observer_bandwidth_radps", [](const G& g) { return g.observer.bandwidth_radps; },
          "rad/s")
      .def_property_readonly(
          "observer_yaw_max_m", [](const G& g) { return g.observer.yaw_max_m; }, "m")
      .def_property_readonly("observer_surge_max", [](const G& g) { return g.observer.surge_max; });
}

void bind_mode_gains(py::module_& module) {
  py::class_<ModeGains>(module, "ModeGains",
                        "The gains of each mode: one set for all modes, or a set of its own for "
                        "some. Functions that need it also accept a `Gains`.")
      .def(py::init<const Gains<double>&>(), py::arg("gains"))
      .def(
          "in_mode",
          [](const ModeGains& gains, const std::string& mode) {
            return gains.in(value_of(kYawModeNames, mode, "mode"));
          },
          py::arg("mode"),
          "The gains to use in the mode \"differential\", \"steering\" or \"combined\".");
  py::implicitly_convertible<Gains<double>, ModeGains>();
  bind_read(
      module, "read_mode_gains", [](const auto& path) { return read_mode_gains(path); },
      "Reads a gains.json with the gains of each mode. Raises InputError.");
}

void bind_gains(py::module_& module) {
  using G = Gains<double>;
  py::class_<G> bound(
      module, "Gains",
      "The controller's gains, all > 0. Heading law: slope lambda_ of the sliding surface (1/s), "
      "largest corrective yaw acceleration mu (rad/s^2), half width epsilon of the boundary "
      "layer (rad/s), and a friction width (rad/s). At yaw rates below the friction width, "
      "Coulomb friction is fed forward only in part. The friction width depends on the mode: "
      "friction_width_radps in steering mode, combined_friction_width_radps in combined mode "
      "(default: half of friction_width_radps, at least 0.02), 0.02 in differential mode. With "
      "an observer, it is friction_width_radps in all modes. Speed law: largest corrective "
      "acceleration speed_mu (m/s^2), half width speed_epsilon of the boundary layer (m/s). "
      "Disturbance observer (all three 0: no observer): observer_bandwidth_radps, and the "
      "largest compensated yaw moment observer_yaw_max_m (m) and force observer_surge_max, both "
      "divided by F_max.");
  bound.def(py::init(&gains_from), py::kw_only(), py::arg("lambda_"), py::arg("mu"),
            py::arg("epsilon"), py::arg("speed_mu"), py::arg("speed_epsilon"),
            py::arg("friction_width_radps") = kFrictionWidth_radps.min,
            py::arg("combined_friction_width_radps") = py::none(),
            py::arg("observer_bandwidth_radps") = 0.0, py::arg("observer_yaw_max_m") = 0.0,
            py::arg("observer_surge_max") = 0.0);
  bind_gain_values(bound);
  bind_read(
      module, "read_gains", [](const auto& path) { return read_gains(path); },
      "Reads the common gains of a gains.json. Modes can have gains of their own, which only "
      "read_mode_gains reads. Raises InputError.");
  module.def(
      "write_gains",
      [](const G& gains, const std::filesystem::path& path) {
        value_or_raise(write_gains(gains, path));
      },
      py::arg("gains"), py::arg("path"),
      "Writes gains.json with the gains alone, without the results of tuning. Raises InputError.");
}

}  // namespace

void bind_model(py::module_& module) {
  bind_findings(module);
  bind_vehicle(module);
  bind_estimate(module);
  bind_model_class(module);
  bind_gains(module);
  bind_mode_gains(module);
  py::dict units;
  for (const ParameterInfo& parameter : parameter_table()) {
    units[py::str(std::string(parameter.name))] = parameter.unit;
  }
  module.attr("units") = units;
}

}  // namespace awmr::python
