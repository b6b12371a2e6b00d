// Svg: a small writer of SVG. Coordinates are in user units (pixels at natural size), the origin is at the
// top left.
#pragma once

#include <string>
#include <vector>

namespace tumblesight::sim {

// For text and attribute values in HTML and SVG.
std::string escape_markup(const std::string& text);

struct Point {
  double x = 0.0;
  double y = 0.0;
};

struct Stroke {
  std::string colour = "#333";
  double width = 1.0;
  std::string dash;  // as in stroke-dasharray; empty: solid
  double opacity = 1.0;
};

struct TextStyle {
  std::string anchor = "start";  // start, middle, end
  double size = 12.0;
  std::string colour = "#444";
  bool bold = false;
  double rotate_deg = 0.0;  // about the point of the text
};

class Svg {
 public:
  // `description`: alternative text for readers who cannot see the picture.
  Svg(double width, double height, const std::string& description);

  void line(Point from, Point to, const Stroke& stroke);
  void polyline(const std::vector<Point>& points, const Stroke& stroke);
  void circle(Point centre, double radius, const std::string& fill, double opacity = 1.0);
  void ring(Point centre, double radius, const Stroke& stroke);
  void rectangle(Point corner, double width, double height, const std::string& fill);
  void image(Point corner, double side, const std::string& uri);  // square, pixels kept sharp
  void text(Point at, const std::string& content, const TextStyle& style = {});

  std::string text() const;  // the <svg> element, for a page

 private:
  std::string body_;
};

// The same element for a file of its own: with a font and a white background.
std::string standalone_svg(const std::string& svg);

}  // namespace tumblesight::sim
