#include "service/acquisition/cell_operation.hpp"
#include "service/http/cell_view.hpp"
#include "service/http/route_table.hpp"
#include "service/http/scene_view.hpp"

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
       .summary = "The recipes that a run may follow",
       .handle = get_recipes,
       .answers = {{.schema = "Recipes"}}},
      {.method = "GET",
       .path = "/api/v1/cell",
       .summary = "What the cell is made of: arm, block, probe, limits, speeds",
       .handle = get_cell,
       .answers = {{.schema = "Cell"}}},
      {.method = "GET",
       .path = "/api/v1/cell/joints",
       .summary = "Where the arm is, as the controller told last, and how old that is",
       .handle = get_joints,
       .answers = {{.schema = "Joints"}}},
      {.method = "GET",
       .path = "/api/v1/faults",
       .summary = "All that can go wrong: cause, what the robot did, what to do",
       .handle = get_faults,
       .answers = {{.schema = "Faults"}}},
  };
}

}  // namespace cell
