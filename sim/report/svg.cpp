#include "sim/report/svg.hpp"

#include <fmt/format.h>

namespace tumblesight::sim {
namespace {

std::string stroke_attributes(const Stroke& stroke) {
  std::string text =
      fmt::format("stroke=\"{}\" stroke-width=\"{:.2f}\" fill=\"none\"", stroke.colour, stroke.width);
  if (!stroke.dash.empty()) text += fmt::format(" stroke-dasharray=\"{}\"", stroke.dash);
  if (stroke.opacity < 1.0) text += fmt::format(" stroke-opacity=\"{:.2f}\"", stroke.opacity);
  return text;
}

}  // namespace

std::string escape_markup(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

Svg::Svg(double width, double height, const std::string& description) {
  body_ = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {:.0f} {:.0f}\" role=\"img\" "
      "aria-label=\"{}\">\n",
      width, height, escape_markup(description));
}

void Svg::line(Point from, Point to, const Stroke& stroke) {
  body_ += fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n", from.x, from.y,
                       to.x, to.y, stroke_attributes(stroke));
}

void Svg::polyline(const std::vector<Point>& points, const Stroke& stroke) {
  if (points.size() < 2) return;
  body_ += "<polyline points=\"";
  for (const Point& point : points) body_ += fmt::format("{:.1f},{:.1f} ", point.x, point.y);
  body_ +=
      fmt::format("\" stroke-linejoin=\"round\" stroke-linecap=\"round\" {}/>\n", stroke_attributes(stroke));
}

void Svg::circle(Point centre, double radius, const std::string& fill, double opacity) {
  body_ +=
      fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" fill=\"{}\" fill-opacity=\"{:.2f}\"/>\n",
                  centre.x, centre.y, radius, fill, opacity);
}

void Svg::ring(Point centre, double radius, const Stroke& stroke) {
  body_ += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" {}/>\n", centre.x, centre.y, radius,
                       stroke_attributes(stroke));
}

void Svg::rectangle(Point corner, double width, double height, const std::string& fill) {
  body_ += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\"/>\n",
                       corner.x, corner.y, width, height, fill);
}

void Svg::image(Point corner, double side, const std::string& uri) {
  body_ += fmt::format(
      "<image x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" "
      "style=\"image-rendering:pixelated\" "
      "href=\"{}\"/>\n",
      corner.x, corner.y, side, side, escape_markup(uri));
}

void Svg::text(Point at, const std::string& content, const TextStyle& style) {
  body_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"{:.1f}\" text-anchor=\"{}\" fill=\"{}\"",
                       at.x, at.y, style.size, style.anchor, style.colour);
  if (style.bold) body_ += " font-weight=\"600\"";
  if (style.rotate_deg != 0.0) {
    body_ += fmt::format(" transform=\"rotate({:.0f} {:.1f} {:.1f})\"", style.rotate_deg, at.x, at.y);
  }
  body_ += ">" + escape_markup(content) + "</text>\n";
}

std::string Svg::text() const {
  return body_ + "</svg>\n";
}

std::string standalone_svg(const std::string& svg) {
  static const std::string kTag = "<svg ";
  return kTag + "font-family=\"sans-serif\" style=\"background:#fff\" " + svg.substr(kTag.size());
}

}  // namespace tumblesight::sim
