#pragma once

#include "calib_core/planning/internal/fedorov_exchange.hpp"

namespace calib {

/// Exchanges candidates until the condition number of the taken rows, the largest over the smallest singular
/// value of their columns as they are, goes down no more. What is missed and what is added is judged by a
/// smooth stand-in, a power mean of the variances along the principal directions that gives the worst ones
/// most of the say; the best of it on a short list by the condition number itself.
void lower_condition_number(TouchExchange& exchange);

/// The square root of the largest over the smallest eigenvalue.
double condition_number_of_information(const Eigen::MatrixXd& information);

}  // namespace calib
