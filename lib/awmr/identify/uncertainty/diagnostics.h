/// Tests of a fit's assumptions about its residuals. Private to identify/.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "awmr/model/record.h"

namespace awmr {

/// Anderson-Darling against the normal distribution, mean and variance estimated; p by D'Agostino &
/// Stephens (1986), table 4.9. None below 8 residuals.
std::optional<Diagnostic> normality(std::span<const double> residuals);

/// Ljung-Box: are the first `lags` autocorrelations those of white noise?
std::optional<Diagnostic> whiteness(std::span<const double> residuals, int lags);

/// Von Neumann's ratio of the residuals in order of force, normal approximation, one-sided:
/// neighbours that err alike mean that the curve bends otherwise. None below 8 residuals.
/// `forces`: of the runs, in any unit, as many as residuals.
std::optional<Diagnostic> curvature(std::span<const double> forces,
                                    const Eigen::VectorXd& residuals);

/// F test of lack of fit against the scatter of repeats at the same force. None without repeats.
std::optional<Diagnostic> lack_of_fit(std::span<const double> forces,
                                      const Eigen::VectorXd& residuals, int parameters);

/// Externally studentised: e_i / (s_(i) sqrt(1 - h_i)), Student's t with dof - 1 degrees of
/// freedom. `leverages`: h_i in [0, 1], as many as residuals. Empty where dof < 2 or without leverages.
Eigen::VectorXd studentised(const Eigen::VectorXd& residuals, const Eigen::VectorXd& leverages,
                            int degrees_of_freedom);

}  // namespace awmr
