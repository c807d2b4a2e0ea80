/// Statistical tests of the residuals of a fit. Private to identify/.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "awmr/model/record.h"

namespace awmr {

/// Anderson-Darling test for normality with estimated mean and variance; p by D'Agostino & Stephens
/// (1986), table 4.9. Empty for fewer than 8 residuals, or if all are equal.
std::optional<Diagnostic> normality(std::span<const double> residuals);

/// Ljung-Box test for white noise, over the first `lags` autocorrelations. Empty for fewer than
/// `lags` + 2 residuals, or if all are equal.
std::optional<Diagnostic> whiteness(std::span<const double> residuals, int lags);

/// Von Neumann's ratio test (normal approximation, one-sided) of the residuals in the order of the
/// forces. A small p means that runs at similar forces deviate from the fitted curve to the same
/// side. The resistance then has another shape than the curve. Empty for fewer than 8 residuals, or
/// if all are equal. `forces`: one per residual, in any unit.
std::optional<Diagnostic> curvature(std::span<const double> forces,
                                    const Eigen::VectorXd& residuals);

/// F test of lack of fit: compares the distance of the curve from the mean of repeated runs with
/// the scatter of the repeats. Empty if no runs have equal forces, or if runs at equal forces do
/// not scatter. Empty also if there are at most `parameters` different forces, the number of free
/// parameters of the curve.
std::optional<Diagnostic> lack_of_fit(std::span<const double> forces,
                                      const Eigen::VectorXd& residuals, int parameters);

/// Residuals in standard deviations, each from the fit without its own row (externally
/// studentised): e_i / (s_(i) sqrt(1 - h_i)), with the leverages h_i in [0, 1] and the standard
/// deviation s_(i) of the fit without row i. They have Student's t distribution with
/// degrees_of_freedom - 1. Empty if degrees_of_freedom < 2 or without leverages.
Eigen::VectorXd studentised(const Eigen::VectorXd& residuals, const Eigen::VectorXd& leverages,
                            int degrees_of_freedom);

}  // namespace awmr
