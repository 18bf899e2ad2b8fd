#pragma once

#include <cstdint>

#include "service/http/routes.hpp"

namespace cell {

/// GET runs/{id}/result of a run that is in the store: touchcal/result/1; 409 before there is a result.
HttpResponse get_result(const Operation& operation, std::int64_t id);

/// GET runs/{id}/arm: the calibrated arm as a file of schema touchcal/arm/1; 409 before there is a result, or
/// when the cell is no longer the one that the run was made in.
HttpResponse get_arm(const Operation& operation, std::int64_t id);

}  // namespace cell
