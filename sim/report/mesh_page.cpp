#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "sim/report/mesh_report.hpp"
#include "sim/report/page.hpp"
#include "sim/report/picture.hpp"
#include "sim/report/svg.hpp"

namespace tumblesight::sim {
namespace {

constexpr double kSide = 320.0;       // of a picture
constexpr double kAxisLength = 0.44;  // of its side
constexpr Rgb kNothing{242, 243, 245};

Rgb shaded(const Rgb& colour, float brightness) {
  Rgb result{};
  for (std::size_t i = 0; i < result.size(); ++i)
    result[i] = static_cast<std::uint8_t>(std::lround(static_cast<float>(colour[i]) * brightness));
  return result;
}

Picture picture_of(const SideView& view) {
  Picture picture{view.pixels, view.pixels, {}};
  for (std::size_t i = 0; i < view.brightness.size(); ++i) {
    const float brightness = view.brightness[i];
    picture.pixels.push_back(brightness > 0.0F ? shaded(sequential_colour(view.nearness[i]), brightness)
                                               : kNothing);
  }
  return picture;
}

// Red, green and blue for x, y and z, as is usual.
const char* colour_of_axis(const char* name) {
  static constexpr const char* kColours[] = {"#b83227", "#2f7a3d", "#1b5e9e"};
  return kColours[name[1] - 'x'];
}

// The positive direction of an axis that lies in the picture, from its middle.
void draw_axis(const char* name, Point direction, Svg& svg) {
  const double sign = name[0] == '-' ? -1.0 : 1.0;
  const Point middle{0.5 * kSide, 0.5 * kSide};
  const Point end{middle.x + sign * kAxisLength * kSide * direction.x,
                  middle.y + sign * kAxisLength * kSide * direction.y};
  Stroke stroke;
  stroke.colour = colour_of_axis(name);
  stroke.width = 2.0;
  svg.line(middle, end, stroke);
  svg.text({end.x + 5.0, end.y - 5.0}, std::string(1, name[1]), {"start", 14.0, colour_of_axis(name), true});
}

std::string side_figure(const SideView& view) {
  Svg svg(kSide, kSide, fmt::format("The mesh from {}", view.side.from));
  svg.image({0.0, 0.0}, kSide, png_data_uri(picture_of(view)));
  draw_axis(view.side.right, {1.0, 0.0}, svg);
  draw_axis(view.side.up, {0.0, -1.0}, svg);
  svg.circle({0.5 * kSide, 0.5 * kSide}, 3.0, colour_of_axis(view.side.from));
  return html_figure(fmt::format("From {}", view.side.from), svg.text(), "");
}

std::vector<std::string> texts_of(const MeshInspection& found, bool notes) {
  std::vector<std::string> texts;
  for (const Finding& finding : found.findings) {
    if ((finding.severity == Severity::kNote) == notes)
      texts.push_back(
          fmt::format("{}: {} {}", severity_name(finding.severity), finding.text, finding.remedy));
  }
  return texts;
}

std::string middle_of(const SideView& view) {
  const Eigen::Vector3d& middle_m = view.middle_trf_m;
  if (middle_m.isZero()) return "the origin of the target frame";
  return fmt::format("({:.4g}, {:.4g}, {:.4g}) m of the target frame", middle_m.x(), middle_m.y(),
                     middle_m.z());
}

}  // namespace

std::string mesh_page(const MeshReport& report, const std::array<SideView, 6>& views) {
  const std::string name = std::filesystem::path(report.file).filename().string();
  std::string body = fmt::format(
      "<h1>Mesh {}</h1>\n<p class=sub>{:.3g} m wide pictures; {} "
      "is in their middle</p>\n",
      escape_markup(name), views.front().swath_m, middle_of(views.front()));
  body += html_notices(texts_of(report.found, false), texts_of(report.found, true));
  body += "<div class=facts>\n";
  for (const SideView& view : views) body += side_figure(view);
  body += "</div>\n";
  body += "<h2>What the file holds</h2>\n<table>";
  for (const auto& [fact, value] : mesh_facts(report))
    body += fmt::format("<tr><td>{}</td><td>{}</td></tr>\n", escape_markup(fact), escape_markup(value));
  body +=
      "</table>\n<h2>Symmetry</h2>\n<p>How far parts of a turn about the principal axes move the outer "
      "surface on average, in per cent of the radius and at least.</p>\n";
  body += html_text(symmetry_table(report), "results");
  return html_page(name, body + html_footer(report.generated, report.command));
}

}  // namespace tumblesight::sim
