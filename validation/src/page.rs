//! The report as a page (`report.html`), a single file without scripts and external resources.

use super::findings::ReportTable;
use super::report::{Case, Report, cheapest};
use foldwell::output::figure::chart::svg;
use foldwell::output::figure::escaped;

const STYLE: &str = "body{font:15px/1.5 Helvetica,Arial,sans-serif;color:#2e3238;background:#fff;max-width:1100px;\
margin:2em auto;padding:0 1em}table{border-collapse:collapse;margin:1em 0;width:100%}th,td{text-align:left;\
vertical-align:top;padding:.35em .7em;border-bottom:1px solid #dcd9cf}th{border-bottom:2px solid #2e3238}\
.fails{background:#fbe9e6}.mark{font-weight:bold;white-space:nowrap}.holds .mark{color:#2c8a6b}.fails .mark{color:#c8372d}\
code{font-size:13px}summary{cursor:pointer}small{color:#6a6760}svg{max-width:800px;height:auto}td.n{white-space:nowrap}";

/// Returns the text of the page.
pub fn html(report: &Report) -> String {
    let mut text = format!(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width\">\n<title>Validation of foldwell</title>\n\
         <style>{STYLE}</style></head><body>\n<h1>Validation of foldwell {}</h1>\n<p><b>{}.</b> {}</p>\n",
        escaped(report.version),
        escaped(&report.verdict()),
        if report.interrupted { "It was stopped before all claims were checked." } else { "" }
    );
    text += "<table><tr><th></th><th>claim</th><th>expected</th><th>found</th><th>seconds</th></tr>\n";
    report.cases.iter().for_each(|case| text += &row(case));
    text += "</table>\n";
    if !report.diagrams.is_empty() {
        text += "<h2>Error against run time</h2>\n<p>Each mark is a method at one setting: further left its answer is nearer to the \
                 right one, lower it came sooner. Times are medians of five runs in turns. Rest the pointer on a mark to \
                 see its setting.</p>\n";
    }
    for diagram in &report.diagrams {
        text += &svg(&diagram.chart());
        text += &table(&cheapest(diagram));
    }
    report.charts.iter().for_each(|chart| text += &svg(chart));
    report.tables.iter().for_each(|grid| text += &table(grid));
    text + "</body></html>\n"
}

fn row(case: &Case) -> String {
    let (class, mark) = if case.passed { ("holds", "\u{2713}") } else { ("fails", "\u{2717} fails") };
    let miss = if case.passed { String::new() } else { format!("<br><b>{}</b>", escaped(&case.distance())) };
    format!(
        "<tr class=\"{class}\"><td class=\"mark\">{mark}</td><td><details><summary>{}</summary><small>{}<br>Tolerance: {}\
         <br><code>{}</code>, <code>{}</code></small></details></td><td>{}</td><td>{}{miss}</td>\
         <td class=\"n\">{:.2}</td></tr>\n",
        escaped(&case.claim),
        escaped(&case.source),
        escaped(&case.reason),
        escaped(&case.command),
        escaped(&case.value),
        escaped(&case.expectation()),
        escaped(&case.finding()),
        case.seconds
    )
}

fn table(grid: &ReportTable) -> String {
    let cells = |row: &[String], kind: &str| -> String {
        row.iter().map(|cell| format!("<{kind}>{}</{kind}>", escaped(cell))).collect()
    };
    let rows: String = grid.rows.iter().map(|row| format!("<tr>{}</tr>\n", cells(row, "td"))).collect();
    format!("<h3>{}</h3>\n<table><tr>{}</tr>\n{rows}</table>\n", escaped(&grid.title), cells(&grid.header, "th"))
}
