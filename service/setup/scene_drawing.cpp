#include "service/setup/scene_drawing.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>

#include "calib_core/geometry/units.hpp"
#include "service/base/escaped_markup.hpp"

namespace cell {
namespace {

/// What is drawn to the right and upwards, in R_-1; in the order of SceneTitles.
struct View {
  Eigen::Vector3d right;
  Eigen::Vector3d up;
};

const std::array<View, 3>& scene_views() {
  static const std::array<View, 3> views{View{Eigen::Vector3d::UnitX(), -Eigen::Vector3d::UnitY()},
                                         View{Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitZ()},
                                         View{-Eigen::Vector3d::UnitZ(), -Eigen::Vector3d::UnitY()}};
  return views;
}

constexpr double kViewRoomMm = 80.0;
constexpr double kTitleMm = 60.0;

/// One view; its extent grows with what is drawn. Down the page is positive.
class ViewDrawing {
 public:
  explicit ViewDrawing(const View& view) : view_(view) {}

  void box(const calib::Box& box, const char* style) {
    const Eigen::Vector2d a = at(box.min_m), b = at(box.max_m);
    const Eigen::Vector2d low = a.cwiseMin(b), size = (b - a).cwiseAbs();
    grow(low, 0.0);
    grow(low + size, 0.0);
    drawn_ += fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" {}><title>{}</title></rect>\n",
        low.x(), low.y(), size.x(), size.y(), style, escaped_markup(box.name));
  }
  void capsule(const calib::Capsule& body, const calib::Chain& chain, const char* color) {
    const calib::Segment axis = calib::axis_in_block(body, chain);
    const Eigen::Vector2d from = at(axis.from_m), to = at(axis.to_m);
    const double radius_mm = calib::mm_from_metres(body.radius_m);
    grow(from, radius_mm);
    grow(to, radius_mm);
    drawn_ += fmt::format(
        "<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\" stroke=\"{}\" stroke-width=\"{:.1f}\" "
        "stroke-linecap=\"round\" stroke-opacity=\"0.6\"><title>{}</title></path>\n",
        from.x(), from.y(), to.x(), to.y() + 0.01, color, 2.0 * radius_mm, escaped_markup(body.name));
  }
  void face(const calib::Face& face, std::size_t index) {
    const Eigen::Vector3d u = face.half_extent_m.x() * face.edge_u,
                          v = face.half_extent_m.y() * face.edge_v();
    std::string points;
    for (const Eigen::Vector3d& corner :
         {Eigen::Vector3d(u + v), Eigen::Vector3d(u - v), Eigen::Vector3d(-u - v), Eigen::Vector3d(v - u)}) {
      const Eigen::Vector2d point = at(face.center_m + corner);
      points += fmt::format("{:.1f},{:.1f} ", point.x(), point.y());
    }
    drawn_ += fmt::format(
        "<polygon points=\"{}\" fill=\"#2a7\" fill-opacity=\"0.3\" stroke=\"#2a7\" stroke-width=\"4\">"
        "<title>{}</title></polygon>\n",
        points, calib::face_name(index));
  }
  void origin() {
    drawn_ += R"(<circle cx="0" cy="0" r="8" fill="#c22"><title>origin of the block's frame</title></circle>)"
              "\n";
  }
  [[nodiscard]] double width() const { return high_.x() - low_.x() + 2.0 * kViewRoomMm; }
  [[nodiscard]] double height() const { return high_.y() - low_.y() + 2.0 * kViewRoomMm + kTitleMm; }
  /// Placed with its upper left corner there.
  [[nodiscard]] std::string placed(double x_mm, std::string_view name) const {
    const std::string title = fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"40\">{}</text>\n",
                                          low_.x(), low_.y() - kViewRoomMm, name);
    return fmt::format("<g transform=\"translate({:.1f} {:.1f})\">\n{}{}</g>\n",
                       x_mm + kViewRoomMm - low_.x(), kTitleMm + kViewRoomMm - low_.y(), title, drawn_);
  }

 private:
  [[nodiscard]] Eigen::Vector2d at(const Eigen::Vector3d& point_m) const {
    return {calib::mm_from_metres(point_m.dot(view_.right)), -calib::mm_from_metres(point_m.dot(view_.up))};
  }
  void grow(const Eigen::Vector2d& point, double radius) {
    low_ = low_.cwiseMin((point.array() - radius).matrix());
    high_ = high_.cwiseMax((point.array() + radius).matrix());
  }

  const View& view_;
  std::string drawn_;
  Eigen::Vector2d low_ = Eigen::Vector2d::Zero(), high_ = Eigen::Vector2d::Zero();
};

ViewDrawing drawing_of(const Cell& scene, const View& view) {
  ViewDrawing drawing(view);
  const calib::Chain chain = calib::forward_chain(scene.arm.model, scene.park_joints);
  drawing.box(scene.workspace_box, R"(fill="none" stroke="#36c" stroke-width="4" stroke-dasharray="20 12")");
  for (const calib::Box& box : scene.keep_out_boxes)
    drawing.box(box, R"(fill="#c22" fill-opacity="0.12" stroke="#c22" stroke-width="3")");
  for (const calib::Box& box : scene.block.solids)
    drawing.box(box, R"(fill="#999" fill-opacity="0.5" stroke="#555" stroke-width="3")");
  for (std::size_t i = 0; i < scene.block.faces.size(); ++i) drawing.face(scene.block.faces[i], i);
  for (const calib::Capsule& body : scene.arm.bodies) drawing.capsule(body, chain, "#e90");
  for (const calib::Capsule& body : scene.probe.bodies) drawing.capsule(body, chain, "#555");
  drawing.origin();
  return drawing;
}

}  // namespace

std::string scene_svg(const Cell& scene, const SceneTitles& titles) {
  std::string drawn;
  double width = 0.0, height = 0.0;
  for (std::size_t i = 0; i < titles.size(); ++i) {
    const ViewDrawing drawing = drawing_of(scene, scene_views()[i]);
    drawn += drawing.placed(width, titles[i]);
    width += drawing.width();
    height = std::max(height, drawing.height());
  }
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {:.0f} {:.0f}\" font-family=\"sans-serif\" "
      "role=\"img\">\n<title>{}</title>\n{}</svg>\n",
      width, height, escaped_markup(scene.name), drawn);
}

std::string scene_html(const Cell& scene, const std::vector<std::string>& remarks) {
  std::string list;
  for (const std::string& remark : remarks) list += "<li>" + escaped_markup(remark) + "</li>\n";
  return fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta http-equiv=\"refresh\" "
      "content=\"1\"><title>{0}</title></head>\n<body style=\"font-family:sans-serif\"><h1>{0}</h1>\n{1}"
      "<p>Orange: the arm in its park posture. Dark: probe. Grey: block and plate, with the touched faces "
      "green. Red: kept out of. Dashed: workspace box. Red point: origin of the block's frame.</p>\n"
      "<ul>\n{2}</ul></body></html>\n",
      escaped_markup(scene.name), scene_svg(scene), list);
}

}  // namespace cell
