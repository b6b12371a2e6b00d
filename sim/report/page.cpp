#include "sim/report/page.hpp"

#include <fmt/format.h>

#include "sim/report/svg.hpp"

namespace tumblesight::sim {
namespace {

constexpr const char* kStyle = R"css(
:root { color-scheme: light; }
* { box-sizing: border-box; }
body { margin: 0; background: #fff; color: #22262d; line-height: 1.5; font-size: 15px;
       font-family: "Inter", "Helvetica Neue", "Segoe UI", Arial, "Liberation Sans", sans-serif; }
main { max-width: 1080px; margin: 0 auto; padding: 44px 32px 56px; }
h1 { font-size: 30px; line-height: 1.2; margin: 0 0 4px; letter-spacing: -0.01em; }
h2 { font-size: 18px; margin: 40px 0 6px; }
p { margin: 6px 0 14px; max-width: 46em; }
.sub { color: #6b7280; margin-bottom: 20px; }
.notice.remark { border-color: #b58a1b; background: #fcf8ec; }
.notice + .lead { margin-top: 20px; }
.lead { font-size: 18px; line-height: 1.45; max-width: 44em; margin: 0 0 22px; }
.notice { border-left: 4px solid #b83227; background: #fdf3f2; padding: 10px 16px; margin: 0 0 10px; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
th { text-align: left; font-weight: 600; color: #4b5563; border-bottom: 1.5px solid #22262d; }
th, td { padding: 6px 22px 6px 0; }
td { border-bottom: 1px solid #e4e6ea; }
.number { text-align: right; }
.headline { width: 100%; }
.headline th.number { text-align: right; }
.headline td:last-child, .headline th:last-child { padding-right: 0; }
.paper { color: #6b7280; font-weight: 400; }
.headline td:first-child .paper { padding-left: 18px; }
.results { width: 100%; font-size: 13.5px; } .results th, .results td { padding: 4px 14px 4px 0; }
.results th { white-space: nowrap; } .results td { white-space: nowrap; } .results th.number { text-align: right; }
.results td:last-child, .results th:last-child { padding-right: 0; }
.pair .results th { white-space: normal; vertical-align: bottom; }
.poses { font-size: 13.5px; } .headline + .poses { margin-top: 28px; }
.poses th, .poses td { padding: 3px 22px 3px 0; white-space: nowrap; }
tr.group th { padding-top: 18px; color: #22262d; border-bottom: 1px solid #9aa1ab; }
.met { color: #2f7a3d; font-weight: 600; } .missed { color: #a3552a; } .quiet { color: #8a9099; }
h2.chapter { font-size: 24px; border-top: 2px solid #22262d; padding-top: 18px; margin-top: 56px; break-before: page; }
.chapter + .sub { margin-bottom: 4px; }
.rcnn { color: #1b5e9e; } .cnn { color: #b65a1b; }
.pair { display: grid; grid-template-columns: minmax(0, 1fr) minmax(0, 1fr); gap: 8px 40px; }
figure { margin: 0; break-inside: avoid; }
figcaption { font-size: 13px; color: #5a6069; margin-top: 4px; max-width: 60em; }
.pair h2 { margin-top: 32px; }
svg { display: block; width: 100%; height: auto; font-family: inherit; }
.facts { display: grid; grid-template-columns: repeat(3, minmax(0, 1fr)); gap: 0 40px; align-items: start; }
.facts table { width: 100%; font-size: 13px; }
.facts td { padding: 4px 0; vertical-align: top; }
.facts td:last-child { text-align: right; padding-left: 14px; }
.facts td:first-child { white-space: nowrap; } .facts td:last-child { overflow-wrap: anywhere; }
footer { margin-top: 40px; color: #6b7280; font-size: 13px; border-top: 1px solid #e4e6ea; padding-top: 12px; }
code { font-family: "SF Mono", Consolas, "DejaVu Sans Mono", monospace; font-size: 12px; overflow-wrap: anywhere; }
@media (max-width: 760px) { .pair, .facts { grid-template-columns: 1fr; } main { padding: 24px 16px; } }
@media print { main { max-width: none; padding: 0; } body { font-size: 9.5pt; }
  .lead { font-size: 11pt; } h1 { font-size: 18pt; }
  h2 { font-size: 12pt; margin-top: 22px; break-after: avoid; }
  th, td { padding: 3px 12px 3px 0; } tr { break-inside: avoid; }
  .pair { grid-template-columns: minmax(0, 1fr) minmax(0, 1fr); gap: 4px 20px; }
  .facts { grid-template-columns: repeat(3, minmax(0, 1fr)); gap: 0 20px; } .facts table { font-size: 8pt; }
  .notice, svg, img { print-color-adjust: exact; -webkit-print-color-adjust: exact; }
  @page { size: A4; margin: 14mm; } }
)css";

}  // namespace

std::string html_page(const std::string& title, const std::string& body) {
  return fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>Tumblesight: "
      "{}</title>\n<style>{}</style>\n</head>\n<body>\n<main>\n{}</main>\n</body>\n</html>\n",
      escape_markup(title), kStyle, body);
}

std::string html_figure(const std::string& heading, const std::string& svg, const std::string& caption) {
  if (svg.empty()) return {};
  return fmt::format("<figure><h2>{}</h2>\n{}<figcaption>{}</figcaption></figure>\n", heading, svg, caption);
}

std::string not_known_sentence(const std::string& target) {
  return fmt::format("The network does not know the attitude of {} in these frames.",
                     escape_markup(display_name(target)));
}

std::string html_notices(const std::vector<std::string>& notices, const std::vector<std::string>& remarks) {
  std::string html;
  for (const std::string& notice : notices) {
    html += fmt::format("<div class=notice>{}</div>\n", escape_markup(notice));
  }
  for (const std::string& remark : remarks) {
    html += fmt::format("<div class=\"notice remark\">{}</div>\n", escape_markup(remark));
  }
  return html;
}

std::string html_facts(const std::vector<FactList>& lists) {
  std::string html = "<div class=facts>\n";
  for (const FactList& list : lists) {
    html += fmt::format("<section><h2>{}</h2><table>", escape_markup(list.title));
    for (const auto& [name, value] : list.facts) {
      html += fmt::format("<tr><td>{}</td><td>{}</td></tr>\n", escape_markup(name), escape_markup(value));
    }
    html += "</table></section>\n";
  }
  return html + "</div>\n";
}

std::string html_console(const std::string& recording) {
  if (recording.empty()) return {};
  return fmt::format("<p>Step through this run in the console: <code>tumblesight console {}</code></p>\n",
                     escape_markup(recording));
}

std::string html_footer(const std::string& generated, const std::string& command) {
  return fmt::format("<footer>{}<br><code>{}</code></footer>\n", escape_markup(generated),
                     escape_markup(command));
}

}  // namespace tumblesight::sim
