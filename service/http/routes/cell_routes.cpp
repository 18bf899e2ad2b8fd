#include "service/acquisition/cell_operation.hpp"
#include "service/documents/cell_view.hpp"
#include "service/documents/scene_view.hpp"
#include "service/http/routes/route_table.hpp"

namespace cell {
namespace {

HttpResponse get_recipes(const Call& call) { return {.body = recipes_document(call.operation.cell())}; }
HttpResponse get_cell(const Call& call) {
  return {.body = cell_document(call.operation.cell(), call.operation.place())};
}
HttpResponse get_joints(const Call& call) {
  return {.body = joints_document(call.operation.controller_state(), call.operation.status())};
}
HttpResponse get_faults(const Call&) { return {.body = faults_document()}; }

}  // namespace

std::vector<Route> cell_routes() {
  return {
      {.method = "GET",
       .path = "/api/v1/recipes",
       .summary = "The recipes of the cell",
       .handle = get_recipes,
       .answers = {{.schema = "Recipes"}}},
      {.method = "GET",
       .path = "/api/v1/cell",
       .summary = "The parts of the cell: arm, block, probe, limits, speeds",
       .handle = get_cell,
       .answers = {{.schema = "Cell"}}},
      {.method = "GET",
       .path = "/api/v1/cell/joints",
       .summary = "The last reported posture of the arm and its age",
       .handle = get_joints,
       .answers = {{.schema = "Joints"}}},
      {.method = "GET",
       .path = "/api/v1/faults",
       .summary = "All faults: cause, reaction of the robot, what to do",
       .handle = get_faults,
       .answers = {{.schema = "Faults"}}},
  };
}

}  // namespace cell
