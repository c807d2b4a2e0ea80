#include "awmr/identify/logs/problem/nearest_curve.h"

#include <limits>

#include "awmr/core/statistics/linear_algebra.h"

namespace awmr {
namespace {

constexpr Eigen::Index kSpeeds = 12;

struct Nearest {
  Resistance<double> curve{};
  double squares = std::numeric_limits<double>::infinity();
};

/// Least-squares fit of c + alpha w^beta + q w^2 to the forces at the speeds w, for a given beta.
/// The constant c is free, or fixed at `least`. q is 0 unless `quadratic`. The cost is infinite if
/// alpha is not positive, if c is below `least`, or if q is negative.
Nearest fitted(const Eigen::VectorXd& speed, const Eigen::VectorXd& force, double beta,
               bool quadratic, bool free_constant, double least) {
  Eigen::MatrixXd columns(kSpeeds, 1 + quadratic + free_constant);
  columns.col(0) = speed.array().pow(beta);
  if (quadratic) columns.col(1) = speed.array().square();
  if (free_constant) columns.col(1 + quadratic).setOnes();
  const Eigen::VectorXd wanted = force.array() - (free_constant ? 0.0 : least);
  const Eigen::VectorXd x = PivotedQr(columns).solve(wanted);
  const double constant = free_constant ? x(1 + quadratic) : least;
  const bool possible = x(0) > 0.0 && constant >= least && (!quadratic || x(1) >= 0.0);
  if (!possible) return {};
  return {{.alpha = x(0), .beta = beta, .coulomb = constant, .quadratic = quadratic ? x(1) : 0.0},
          (columns * x - wanted).squaredNorm()};
}

}  // namespace

Resistance<double> nearest_curve(const Resistance<double>& curve, const FamilyTerms& terms,
                                 double fastest) {
  constexpr double kMinShare = 0.1;
  constexpr double kMinBeta = 0.2;
  constexpr double kBetaStep = 0.1;
  constexpr int kBetas = 24;  // number of exponents that are tried, from 0.2 to 2.5
  const Eigen::VectorXd speed = Eigen::VectorXd::LinSpaced(kSpeeds, fastest / kSpeeds, fastest);
  const Eigen::VectorXd force = speed.unaryExpr([&](double w) { return curve.at(w); });
  const bool constant = terms.coulomb || terms.dead_zone;
  const double least = constant ? kMinShare * curve.at(0.5 * fastest) : 0.0;
  Nearest best;
  const auto consider = [&](double beta) {
    for (const bool quadratic : {false, true}) {
      for (const bool free_constant : {false, true}) {
        if ((quadratic && !terms.quadratic) || (free_constant && !constant)) continue;
        const Nearest one = fitted(speed, force, beta, quadratic, free_constant, least);
        if (one.squares < best.squares) best = one;
      }
    }
  };
  if (!terms.beta) consider(1.0);
  for (int i = 0; terms.beta && i < kBetas; ++i) consider(kMinBeta + kBetaStep * i);
  return best.squares < std::numeric_limits<double>::infinity() ? best.curve : curve;
}

}  // namespace awmr
