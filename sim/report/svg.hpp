// Svg: a small writer of inline SVG. Coordinates in user units (pixels at natural size), origin at the top
// left.
#pragma once

#include <string>
#include <vector>

namespace tumblesight::sim {

// For text and attribute values in HTML and SVG alike.
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
  double rotate_deg = 0.0;  // about the text's own point
};

class Svg {
 public:
  // `description`: what a reader who cannot see the picture is told.
  Svg(double width, double height, const std::string& description);

  void line(Point from, Point to, const Stroke& stroke);
  void polyline(const std::vector<Point>& points, const Stroke& stroke);
  void circle(Point centre, double radius, const std::string& fill, double opacity = 1.0);
  void ring(Point centre, double radius, const Stroke& stroke);
  void rectangle(Point corner, double width, double height, const std::string& fill);
  void image(Point corner, double side, const std::string& uri);  // square, pixels kept sharp
  void text(Point at, const std::string& content, const TextStyle& style = {});

  std::string text() const;  // the whole <svg> element

 private:
  std::string body_;
};

}  // namespace tumblesight::sim
