#include "service/acquisition/cell_operation.hpp"
#include "service/documents/cell_view.hpp"
#include "service/documents/scene_view.hpp"
#include "service/http/routes/route_table.hpp"
#include "service/http/routes/services.hpp"

namespace cell {
namespace {

HttpResponse get_recipes(const Call& call) { return {.body = recipes_document(call.reads.cell())}; }
HttpResponse get_cell(const Call& call) {
  return {.body = cell_document(call.reads.cell(), call.reads.place())};
}
Asked ask_joints(const Call&, CellOperation& operation) {
  return {.controller_state = operation.controller_state()};
}
HttpResponse get_joints(const Call& call) {
  return {.body = joints_document(call.asked.controller_state, call.services.feed.status())};
}
HttpResponse get_faults(const Call&) { return {.body = faults_document()}; }

}  // namespace

std::vector<Route> cell_routes() {
  return {
      {.method = "GET",
       .path = "/api/v1/recipes",
       .summary = "The recipes of the cell",
       .handle = get_recipes,
       .answers = {{.schema = "Recipes"}},
       .dispatch = DispatchMode::kStored},
      {.method = "GET",
       .path = "/api/v1/cell",
       .summary = "The parts of the cell: arm, block, probe, limits, speeds",
       .handle = get_cell,
       .answers = {{.schema = "Cell"}},
       .dispatch = DispatchMode::kStored},
      {.method = "GET",
       .path = "/api/v1/cell/joints",
       .summary = "The last reported posture of the arm and its age",
       .handle = get_joints,
       .ask = ask_joints,
       .answers = {{.schema = "Joints"}}},
      {.method = "GET",
       .path = "/api/v1/faults",
       .summary = "All faults: cause, reaction of the robot, what to do",
       .handle = get_faults,
       .answers = {{.schema = "Faults"}}},
  };
}

}  // namespace cell
