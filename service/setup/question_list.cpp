#include "service/setup/questions.hpp"

namespace cell {
namespace {

using enum AnswerKind;
using Questions = std::vector<Question>;

void append(Questions& all, const Questions& more) { all.insert(all.end(), more.begin(), more.end()); }

Questions arm_questions(const ArmChoice& arm) {
  Questions list{
      {"/name", kText, "Name of the cell", "",
       "It stands on the page, in reports and in messages to a broker."},
      {"/arm", kArm, "Arm", "",
       "The name of a shipped arm (tx90, tx60, three-parallel), the path of an arm's file, 'urdf FILE BASE "
       "TIP' for a "
       "URDF robot with the links between which its six joints are, or 'dh FILE standard' (or modified) for "
       "a table of "
       "Denavit-Hartenberg parameters."}};
  if (!arm.urdf.empty() || !arm.dh.empty())
    list.push_back(
        {"/arm/body_radii_mm", kMaybeNumbers,
         "Radii of its six bodies: shoulder, upper arm, elbow, forearm, wrist, flange", "mm",
         "All paths are checked with them. - guesses 9 to 4 % of the arm's length, which may be too "
         "thick to move or too thin to be safe: measure them."});
  append(
      list,
      {{"/arm_serial", kMaybeText, "Serial number of the arm", "",
        "As getVersion(\"ArmSN\") of the controller gives it, else as on its plate; - when it is not known."},
       {"/controller_serial", kMaybeText, "Serial number of the controller", "",
        "As on its plate; - when it is not known."},
       {"/base/position_mm", kMaybeNumbers, "Where the arm's base is in the block's frame: x y z", "mm",
        "The block's frame has its origin in the middle of the block's bottom face and y down. The base is "
        "the point of "
        "axis 1 at the height of the shoulder (where its controller has its world), for an arm of a URDF its "
        "base link, of a "
        "table its first frame. By tape to within the miss is enough: touchcal locate finds it. - stands for "
        "what the "
        "arm's file says."},
       {"/base/rotation_deg", kMaybeNumbers, "How it is turned there: Rot(x) Rot(y) Rot(z)", "deg",
        "90 0 0 for an arm that stands on the floor with its x along the block's x; 90 0 w turns it by w "
        "about the "
        "vertical; -90 0 0 hangs from the ceiling."}});
  return list;
}

void add_places(Questions& list, const CuboidAnswers& block) {
  list.push_back(
      {"/block/places", kCount, "At how many further places is the block to be touched too", "",
       "0 as a rule. On a stand elsewhere it shows more of the arm: the cell then has a recipe `places` "
       "too, in which a person moves the block when the run asks for it."});
  for (std::size_t i = 0; i < block.places.size(); ++i) {
    const std::string pointer = "/block/places/" + std::to_string(i);
    const std::string what = "Place " + std::to_string(i + 2);
    append(list,
           {{pointer + "/name", kText, what + ": its name", "", "a to z, 0 to 9 and _; not first."},
            {pointer + "/position_mm", kNumbers, what + ": where the block's frame is then: x y z", "mm",
             "In the block's frame at its first place; y is down, so that a stand lifts by a negative y."},
            {pointer + "/rotation_deg", kNumbers, what + ": Rot(x) Rot(y) Rot(z)", "deg", ""},
            {pointer + "/within_mm", kNumber, what + ": how far from there a person may put it", "mm",
             "At most 50; the touches find where it is. A dowelled stand whose place is certified: edit "
             "block.json."}});
  }
}

Questions block_questions(const CuboidAnswers& block) {
  Questions list{
      {"/block/name", kText, "Name of the block", "", "As it stands in reports."},
      {"/block/serial", kMaybeText, "Serial number of the block", "", "As engraved; - when it has none."},
      {"/block/size_mm", kNumbers, "Its lengths by the certificate, at 20 C: along x, its height, along z",
       "mm",
       "The block is a cuboid that stands on a face. x leads away from the arm as a rule, z to the left seen "
       "from it."},
      {"/block/std_mm", kNumber, "Standard deviation of each of them", "mm",
       "Half of the certificate's expanded uncertainty (k = 2). Flatness of the faces belongs into it."},
      {"/block/sides", kSides, "Sides that are touched, each with what operators call it", "",
       "-x, +x, -z, +z and -y (the top) by the direction that the side faces, then its name: '-x near, -y "
       "top, -z right, "
       "+z left'. At least three directions; with the ground plate four faces."},
      {"/block/ground_plate", kYesNo, "Does it stand on a certified ground plate that is touched too", "",
       "Its top is in the plane of the block's bottom. Then the height counts as a length, and the arm is "
       "seen lower."}};
  if (block.ground_plate)
    list.push_back({"/block/plate_mm", kNumbers, "Size of the plate: along x, its thickness, along z", "mm",
                    "The block is in its middle. It has 110 mm more than the block along x and z at least."});
  append(list,
         {{"/block/temperature_c", kMaybeNumber, "Temperature of the block", "C",
           "At which the room is kept; - when it comes with each run (touchcal run --block-temperature)."},
          {"/block/std_temperature_k", kNumber, "Standard deviation of the temperature", "K",
           "Of what the block has, not of the thermometer."},
          {"/block/thermal_expansion_per_k", kNumber, "Thermal expansion of its material", "1/K",
           "2.36e-5 for aluminium, 1.15e-5 for steel, 0.1e-5 for Invar."},
          {"/block/certificate/number", kMaybeText, "Number of the certificate", "", "- when there is none."},
          {"/block/certificate/laboratory", kMaybeText, "Laboratory that issued it", "",
           "- when there is none."},
          {"/block/certificate/issued", kMaybeText, "Day of issue", "YYYY-MM-DD", "- when it is not known."},
          {"/block/certificate/valid_until", kMaybeText, "Day until which it is valid", "YYYY-MM-DD",
           "The daemon tells 30 days before; - for no end."}});
  add_places(list, block);
  return list;
}

Questions probe_questions() {
  return {
      {"/probe/name", kText, "Name of the probe", "", "As it stands in reports."},
      {"/probe/serial", kMaybeText, "Serial number of the probe", "", "- when it has none."},
      {"/probe/ball_radius_mm", kNumber, "Radius of the stylus ball", "mm",
       "By its certificate; half the diameter."},
      {"/probe/std_ball_radius_mm", kNumber, "Standard deviation of the radius", "mm", ""},
      {"/probe/pretravel_mm", kNumber, "Pre-travel", "mm",
       "How far the ball goes on from the contact to the trigger, along the stylus. touchcal qualify "
       "measures more."},
      {"/probe/std_pretravel_mm", kNumber, "Standard deviation of the pre-travel", "mm", ""},
      {"/probe/overtravel_mm", kNumber, "Overtravel", "mm",
       "How far the stylus may be bent before it breaks: the smallest of its directions."},
      {"/probe/speed_mm_s", kNumber, "Speed of the contact that counts", "mm/s",
       "At which the pre-travel was measured; at most 8. Each touch is made a second time at this speed."},
      {"/probe/length_mm", kMaybeNumber, "Distance to the ball's centre, along axis 6", "mm",
       "From the wrist centre, not from the flange; for an arm of a URDF or a table from its tip. - stands "
       "for what "
       "the arm's file has, or for the parts below together."},
      {"/probe/stem_length_mm", kNumber, "Stem: from the ball's centre to the probe's body", "mm", ""},
      {"/probe/stem_radius_mm", kNumber, "Radius of the stem", "mm", "Thinner than the ball."},
      {"/probe/body_length_mm", kNumber, "Length of the probe's body", "mm", ""},
      {"/probe/body_radius_mm", kNumber, "Radius of the probe's body", "mm", ""},
      {"/probe/holder_length_mm", kNumber, "Length of the tool holder between flange and probe", "mm",
       "0 for none."},
      {"/probe/holder_radius_mm", kNumber, "Radius of the tool holder, all that is on it included", "mm",
       ""}};
}

void add_box(Questions& list, const std::string& pointer, const std::string& what) {
  append(list, {{pointer + "/name", kText, what + ": its name", "", "As it is called when it is in the way."},
                {pointer + "/min_mm", kNumbers, what + ": smallest x y z", "mm",
                 "In the block's frame; y is down, so that the smallest y is the highest."},
                {pointer + "/max_mm", kNumbers, what + ": largest x y z", "mm",
                 "Above the smallest in each of the three."}});
}

Questions space_questions(const SetupAnswers& answers) {
  Questions list;
  add_box(list, "/workspace_box", "Box in which the arm is to be right");
  list.push_back(
      {"/keep_out_boxes", kCount, "How many boxes must the arm keep out of, besides block and plate", "",
       "Table, fences, machines: everything that it could meet between its park posture and the block."});
  for (std::size_t i = 0; i < answers.keep_out_boxes.size(); ++i)
    add_box(list, "/keep_out_boxes/" + std::to_string(i), "Box " + std::to_string(i + 1) + " to keep out of");
  append(list, {{"/nominal_miss_mm", kNumber,
                 "How far the uncalibrated arm may miss, its place by tape included", "mm",
                 "All paths keep this distance and searches begin so far before a face; 12 for an arm that "
                 "was located."},
                {"/stylus_tilt_max_deg", kNumber, "Largest angle between stylus and face normal", "deg",
                 "Larger shows more of the arm; under 90."},
                {"/touch_noise_mm", kNumber, "Scatter of a touch along the normal, one standard deviation",
                 "mm", "0.02 for a touch probe on an arm."},
                {"/park_joints_deg", kMaybeNumbers, "Park posture, six joints", "deg",
                 "Where a run begins and ends, clear of everything; - searches one."}});
  return list;
}

Questions limit_questions() {
  return {{"/limits/held_out_mean_max_mm", kNumber,
           "Limit: mean distance of touches that were not fitted, on each plane", "mm", ""},
          {"/limits/held_out_rms_max_mm", kNumber, "Limit: their root mean square", "mm", ""},
          {"/limits/condition_number_max", kNumber, "Limit: condition number", "",
           "300 as a rule; a well planned run has 20 to 60."},
          {"/limits/tip_box_max_mm", kNumber,
           "Limit: expanded uncertainty of the tip where it is worst in the box", "mm",
           "k = 2. For the recipes quick and best it becomes what their plans promise and half of it more."}};
}

Questions tool_questions(const SetupAnswers& answers) {
  Questions list{{"/tools", kCount, "How many tools has the arm", "",
                  "Tool centres whose accuracy is predicted and whose programs are corrected."}};
  for (std::size_t i = 0; i < answers.tools.size(); ++i) {
    const std::string pointer = "/tools/" + std::to_string(i), what = "Tool " + std::to_string(i + 1);
    append(list,
           {{pointer + "/name", kText, what + ": its name", "", "As programs call it."},
            {pointer + "/position_mm", kNumbers, what + ": its tip from the wrist centre: x y z", "mm",
             "In R_6, whose origin is the wrist centre and not the flange."},
            {pointer + "/rotation_deg", kNumbers, what + ": Rot(x) Rot(y) Rot(z)", "deg", "As in VAL3."},
            {pointer + "/tip/radius_mm", kMaybeNumber, what + ": radius of the ball at its tip", "mm",
             "Of a tool that can touch the block itself, or with a setting pin in its place (touchcal tool "
             "NAME); "
             "0 for a point, - when it cannot."}});
    if (answers.tools[i].tip)
      list.push_back(
          {pointer + "/tip/std_radius_mm", kNumber, what + ": standard deviation of that radius", "mm", ""});
  }
  append(list,
         {{"/default_recipe", kText, "Recipe of a run that names none: quick or best", "",
           "quick: 40 touches and 10 held out on each face, best: 100."},
          {"/controller/host", kText, "Host of the controller", "", "Where the VAL3 application listens."},
          {"/controller/port", kNumber, "Port of the controller", "", "11000 as a rule."}});
  return list;
}

}  // namespace

std::vector<Question> setup_questions(const SetupAnswers& answers) {
  Questions all;
  const auto append_section = [&all](const char* section, Questions questions) {
    for (Question& question : questions) question.section = section;
    append(all, questions);
  };
  append_section("arm", arm_questions(answers.arm));
  append_section("block", block_questions(answers.block));
  append_section("probe", probe_questions());
  append_section("space", space_questions(answers));
  append_section("limits", limit_questions());
  append_section("tools", tool_questions(answers));
  return all;
}

}  // namespace cell
