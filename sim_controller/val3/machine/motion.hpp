#pragma once

#include <optional>

#include "sim_controller/val3/machine/geometry.hpp"
#include "sim_controller/val3/machine/nodes.hpp"

/// Poses of points and tools as instructions see them, in the unit of the application that runs.
namespace val3 {

/// RunFailure 162, 163.
Trsf point_in_world(const Context& context, const Point& point);
Trsf tool_in_world(const Context& context, const Joint& joints, const Tool& tool);
/// Joints that bring the tool to the point in the point's configuration, nearest to `near`; nothing where
/// there are none. RunFailure 162 to 164.
std::optional<Joint> joints_at(const Context& context, const Tool& tool, const Joint& near,
                               const Point& point);

}  // namespace val3
