#include "comparison/page/html_page.h"

#include "comparison/page/html.h"
#include "core/data_uri.h"

#include <fmt/format.h>

namespace lambert {

namespace {

constexpr std::string_view kStyle = R"(
:root{color-scheme:light dark;--text:#1d2229;--soft:#5a6472;--line:#d5dae1;--ground:#fff;--strong:#0a5f3c}
@media(prefers-color-scheme:dark){:root{--text:#e4e7eb;--soft:#9aa4b1;--line:#363d47;--ground:#15181d;--strong:#6fd6a6}}
*{box-sizing:border-box}
body{margin:0;background:var(--ground);color:var(--text);font:15px/1.5 system-ui,-apple-system,"Segoe UI",Roboto,"Helvetica Neue","Noto Sans","Liberation Sans",Arial,sans-serif}
main{max-width:1200px;margin:0 auto;padding:32px 24px 64px}
h1{font-size:30px;line-height:1.2;margin:0 0 4px;font-weight:650;letter-spacing:-.01em;overflow-wrap:anywhere}
h2{font-size:20px;line-height:1.3;margin:44px 0 10px;padding-top:14px;border-top:1px solid var(--line);font-weight:650}
h3{font-size:15px;line-height:1.3;margin:0 0 6px;font-weight:650}
p{margin:0 0 12px;max-width:82ch}
.subtitle{max-width:none;color:var(--soft);margin:0 0 24px;font-size:16px}
figure{margin:0;min-width:0}
figcaption,caption{color:var(--soft);font-size:13.5px;line-height:1.45;text-align:left}
figcaption{margin-top:6px}
caption{padding-bottom:6px}
img,svg{display:block;max-width:100%;height:auto}
.grid img{width:100%}
svg.plot{width:100%;color:var(--text)}
svg.plot text{font-family:inherit}
.grid{display:grid;gap:26px 28px;margin:14px 0 8px;align-items:start}
.beside{display:grid;grid-template-columns:minmax(0,5fr) minmax(0,7fr);gap:32px;align-items:start}
.wide{overflow-x:auto;margin:10px 0 14px}
table{border-collapse:collapse;font-size:14px;font-variant-numeric:tabular-nums;min-width:min(100%,640px)}
.facts{width:100%}
th,td{padding:5px 10px;text-align:right;border-bottom:1px solid var(--line);vertical-align:baseline}
td{white-space:nowrap}
.facts td{white-space:normal}
th:first-child,td:first-child{text-align:left;padding-left:0;white-space:nowrap}
th{font-weight:600;color:var(--soft);font-size:13px;vertical-align:bottom;line-height:1.3}
.dense{font-size:12.5px;width:100%}
.dense th,.dense td{padding:5px 5px}
.dense th{font-size:12px}
.dense td:first-child,.dense th:first-child{padding-left:0}
.facts td{text-align:left;overflow-wrap:anywhere}
.facts td:first-child{color:var(--soft);width:11em;white-space:normal}
.dense .words,.words{text-align:left;padding-left:16px}
tr.rule td{padding:0;border-bottom:2px solid var(--line)}
td.strong{color:var(--strong);font-weight:650}
.slider{--at:50%;max-width:768px;margin:14px 0 8px}
.views{position:relative;overflow:hidden;touch-action:pan-y;cursor:ew-resize;user-select:none}
.views img{width:100%;pointer-events:none}
.views img+img{position:absolute;inset:0;clip-path:inset(0 0 0 var(--at))}
.views i{position:absolute;top:0;bottom:0;left:var(--at);width:2px;margin-left:-1px;background:#fff;box-shadow:0 0 3px #000}
.views b{position:absolute;top:10px;padding:2px 9px;font-size:13px;font-weight:600;color:#fff;background:#000a;border-radius:3px;left:10px}
.views b+b{left:auto;right:10px}
.slider input{display:block;width:100%;margin:10px 0 4px;accent-color:var(--strong)}
dl{display:grid;grid-template-columns:13em 1fr;gap:7px 20px;margin:0}
dt{font-weight:600}
dd{margin:0}
@media screen and (max-width:820px){.beside,.grid{grid-template-columns:1fr!important}dl{grid-template-columns:1fr}}
@media print{:root{color-scheme:light;--text:#000;--soft:#444;--line:#bbb;--ground:#fff}body{font-size:10.5pt}main{max-width:none;padding:0}
figure,tr,dl>*{break-inside:avoid}h2{break-after:avoid}table{font-size:9pt}.wide{overflow:visible}.dense{font-size:7pt}.dense th{font-size:6.5pt}.dense th,.dense td{padding:2px 3px}h2+p{break-after:avoid}@page{margin:13mm}}
)";

constexpr std::string_view kSliderScript = R"(
for (const figure of document.querySelectorAll('.slider')) {
  const range = figure.querySelector('input'), views = figure.querySelector('.views');
  const show = at => { range.value = 100 * at; figure.style.setProperty('--at', 100 * at + '%'); };
  const drag = event => {
    const box = views.getBoundingClientRect();
    show(Math.min(1, Math.max(0, (event.clientX - box.left) / box.width)));
  };
  range.addEventListener('input', () => show(range.value / 100));
  views.addEventListener('pointerdown', event => { views.setPointerCapture(event.pointerId); drag(event); });
  views.addEventListener('pointermove', event => { if (event.buttons) drag(event); });
  const fromAddress = () => { const at = /slider=([0-9.]+)/.exec(location.hash); if (at) show(Math.min(1, +at[1])); };
  addEventListener('hashchange', fromAddress);
  fromAddress();
}
)";

/// Of a cell; strong or in a column of words.
std::string_view classOf(const HtmlTable& table, std::size_t column, std::size_t columns, bool strong) {
    const bool words = column + table.words >= columns;
    return words ? strong ? " class=\"words strong\"" : " class=\"words\"" : strong ? " class=\"strong\"" : "";
}

std::string tableMarkup(const HtmlTable& table, std::string_view style) {
    std::string text = fmt::format("<div class=\"wide\"><table{}>\n", style);
    if (!table.caption.empty()) text += fmt::format("<caption>{}</caption>\n", htmlEscaped(table.caption));
    if (!table.head.empty()) {
        text += "<thead><tr>";
        for (std::size_t k = 0; k < table.head.size(); ++k)
            text += fmt::format("<th scope=\"col\"{}>{}</th>", classOf(table, k, table.head.size(), false),
                                htmlEscaped(table.head[k]));
        text += "</tr></thead>\n";
    }
    text += "<tbody>\n";
    for (const auto& row : table.rows) {
        if (row.empty()) {
            text += fmt::format("<tr class=\"rule\"><td colspan=\"{}\"></td></tr>\n", table.head.size());
            continue;
        }
        text += "<tr>";
        for (std::size_t k = 0; k < row.size(); ++k)
            text +=
                fmt::format("<td{}>{}</td>", classOf(table, k, row.size(), row[k].strong), htmlEscaped(row[k].text));
        text += "</tr>\n";
    }
    return text + "</tbody></table></div>\n";
}

std::string figureMarkup(const HtmlFigure& figure) {
    std::string text = "<figure>";
    if (!figure.title.empty()) text += fmt::format("<h3>{}</h3>", htmlEscaped(figure.title));
    text += figure.content;
    if (!figure.caption.empty()) text += fmt::format("<figcaption>{}</figcaption>", htmlEscaped(figure.caption));
    return text + "</figure>\n";
}

} // namespace

HtmlPage::HtmlPage(std::string_view title, std::string_view subtitle) : title_(htmlEscaped(title)) {
    body_ = fmt::format("<h1>{}</h1>\n<p class=\"subtitle\">{}</p>\n", title_, htmlEscaped(subtitle));
}

void HtmlPage::section(std::string_view heading) { body_ += fmt::format("<h2>{}</h2>\n", htmlEscaped(heading)); }

void HtmlPage::paragraph(std::string_view text) { body_ += fmt::format("<p>{}</p>\n", htmlEscaped(text)); }

void HtmlPage::table(const HtmlTable& table) { body_ += tableMarkup(table, table.dense ? " class=\"dense\"" : ""); }

void HtmlPage::figures(const std::vector<HtmlFigure>& figures, int columns) {
    body_ += fmt::format("<div class=\"grid\" style=\"grid-template-columns:repeat({},minmax(0,1fr))\">\n", columns);
    for (const HtmlFigure& figure : figures) body_ += figureMarkup(figure);
    body_ += "</div>\n";
}

void HtmlPage::figureAndTable(const HtmlFigure& figure, const HtmlTable& table) {
    body_ += fmt::format("<div class=\"beside\">\n{}{}</div>\n", figureMarkup(figure),
                         tableMarkup(table, " class=\"facts\""));
}

void HtmlPage::slider(const HtmlFigure& left, const HtmlFigure& right, std::string_view caption) {
    slides_ = true;
    body_ +=
        fmt::format("<figure class=\"slider\"><div class=\"views\">{}{}<i></i><b>{}</b><b>{}</b></div>\n"
                    "<input type=\"range\" min=\"0\" max=\"100\" step=\"any\" value=\"50\" aria-label=\"{} to {}\">"
                    "<figcaption>{}</figcaption></figure>\n",
                    left.content, right.content, htmlEscaped(left.title), htmlEscaped(right.title),
                    htmlEscaped(left.title), htmlEscaped(right.title), htmlEscaped(caption));
}

void HtmlPage::definitions(const std::vector<Definition>& definitions) {
    body_ += "<dl>\n";
    for (const Definition& d : definitions)
        body_ += fmt::format("<dt>{}</dt><dd>{}</dd>\n", htmlEscaped(d.term), htmlEscaped(d.meaning));
    body_ += "</dl>\n";
}

std::string HtmlPage::text() const {
    return fmt::format("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
                       "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
                       "<title>{}</title>\n<style>{}</style>\n</head>\n<body>\n<main>\n{}</main>\n{}</body>\n</html>\n",
                       title_, kStyle, body_,
                       slides_ ? fmt::format("<script>{}</script>\n", kSliderScript) : std::string());
}

std::string htmlPng(std::string_view png, int width, int height, std::string_view alternative) {
    return fmt::format("<img src=\"{}\" width=\"{}\" height=\"{}\" alt=\"{}\">", dataUri("image/png", png), width,
                       height, htmlEscaped(alternative));
}

} // namespace lambert
