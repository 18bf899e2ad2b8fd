#pragma once

#include "tests/twins/record.hpp"
#include "tests/twins/scenario.hpp"
#include "tests/twins/twin.hpp"

namespace twins {

/// Takes a twin through the scenario's steps and half a second more. Heartbeats go each 100 ms.
Record carry_out(const Scenario& scenario, Twin& twin);

}  // namespace twins
