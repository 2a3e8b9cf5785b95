#include "validate/page.hpp"

#include "scene/picture.hpp"
#include "validate/plots.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace carom::validate {

namespace {

constexpr std::string_view head = R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>carom: measured against theory and literature</title>
<style>
:root{--paper:#fff;--ink:#171a20;--soft:#3c4350;--rule:#dfe3e8;--axis:#8a93a0;--good:#23806a;--bad:#c0272d;
--c0:#1c6fbf;--c1:#d1570b;--c2:#23806a;--c3:#8a4fb0;--c4:#a0742c}
@media (prefers-color-scheme:dark){:root{--paper:#14171c;--ink:#f0f3f7;--soft:#b4bcc8;--rule:#2b3038;--axis:#6b7482;
--good:#3fb491;--bad:#ff6b6b;--c0:#62b0f5;--c1:#ff9145;--c2:#3fb491;--c3:#c490e8;--c4:#d8ae62}}
body{margin:0 auto;max-width:1180px;padding:24px;background:var(--paper);color:var(--soft);
font:15px/1.5 "DejaVu Sans","Helvetica Neue",Arial,sans-serif}
h1,h2,th,b{color:var(--ink)}h1{font-size:26px;margin:8px 0}h2{font-size:18px;margin:36px 0 8px}
.plots{display:grid;grid-template-columns:repeat(auto-fill,minmax(420px,1fr));gap:24px}
figure{margin:0}figure b{display:block}figcaption{font-size:13px}
svg{width:100%;height:auto}svg text{font-size:13px;fill:var(--soft)}svg .head{font-weight:bold;fill:var(--ink)}
.right{text-anchor:end}.middle{text-anchor:middle}
.paper{fill:var(--paper)}.rule{stroke:var(--rule)}.axis{stroke:var(--axis)}
.line{fill:none;stroke-width:2;stroke-linejoin:round;stroke-linecap:round}
.c0{stroke:var(--c0)}.c1{stroke:var(--c1)}.c2{stroke:var(--c2)}.c3{stroke:var(--c3)}.c4{stroke:var(--c4)}
.dot{stroke:none}.dot.c0{fill:var(--c0)}.dot.c1{fill:var(--c1)}.dot.c2{fill:var(--c2)}.dot.c3{fill:var(--c3)}
.dot.c4{fill:var(--c4)}
.wide{overflow-x:auto}table{border-collapse:collapse;width:100%;font-size:13px}
th,td{padding:5px 8px;text-align:left;vertical-align:top;border-bottom:1px solid var(--rule)}
td:nth-child(2),td:nth-child(4){min-width:180px}td.number{text-align:right;white-space:nowrap}.pass{color:var(--good)}.fail{color:var(--bad);font-weight:bold}
</style>
</head>
<body>
)";

std::string figures_of(const Report& report) {
    std::string text;
    for (const PlotStyle& style : plot_styles()) {
        const std::string svg = plot(style, report.curves);
        if (svg.empty()) continue;
        text += fmt::format("<figure><b>{}</b>\n{}<figcaption>{}</figcaption></figure>\n", scene::escaped(style.title),
                            svg, scene::escaped(style.caption));
    }
    return text;
}

std::string measured_text(const Row& row) {
    if (!row.sigmas) return number_text(row.measured);
    return fmt::format("{} ± {:.2g}", number_text(row.measured), row.standard_error);
}

std::string table_row(const Row& row) {
    const auto percent = row.percent();
    const std::string admitted = row.admitted == 0 ? "0" : number_text(row.admitted);
    return fmt::format("<tr><td>{}</td><td>{}</td><td class=\"number\">{}</td><td>{}</td><td class=\"number\">{}</td>"
                       "<td class=\"number\">{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td>"
                       "<td class=\"{}\">{}</td></tr>\n",
                       scene::escaped(row.claim.name), scene::escaped(row.claim.setup), number_text(row.reference),
                       scene::escaped(row.claim.source), measured_text(row),
                       row.sigmas ? fmt::format("{:+.1f}", *row.sigmas) : "", percent ? signed_text(*percent) : "",
                       admitted, row.passed ? "pass" : "fail", row.passed ? "pass" : "fail");
}

std::string table_of(const Report& report) {
    std::string text = "<div class=\"wide\"><table>\n<tr><th>quantity</th><th>set-up</th><th>reference</th>"
                       "<th>source</th><th>measured</th><th>deviation, standard errors</th><th>deviation, %</th>"
                       "<th>admitted</th><th>verdict</th></tr>\n";
    for (const Row& row : report.rows) text += table_row(row);
    return text + "</table></div>\n";
}

std::string summary_of(const Report& report, Extent extent) {
    const auto failed =
        std::count_if(report.rows.begin(), report.rows.end(), [](const Row& row) { return !row.passed; });
    return fmt::format(
        "<h1>carom, measured against theory and literature</h1>\n<p>carom {}, {} set: {} rows, {} failed. Rows with a "
        "standard error pass within four of them; all pass only within the error that they admit, in the unit of the "
        "quantity. Units: metres, kilograms, seconds; in gases diameter, mass and kT are 1.</p>\n",
        CAROM_VERSION, extent == Extent::full ? "full" : "quick", report.rows.size(), failed);
}

} // namespace

std::string page(const Report& report, Extent extent) {
    std::string text(head);
    text += summary_of(report, extent);
    text += "<div class=\"plots\">\n" + figures_of(report) + "</div>\n<h2>All rows</h2>\n" + table_of(report);
    text += "<h2>Not tested</h2>\n<ul>\n";
    for (const std::string_view what : not_tested()) text += fmt::format("<li>{}</li>\n", scene::escaped(what));
    return text + "</ul>\n</body>\n</html>\n";
}

} // namespace carom::validate
