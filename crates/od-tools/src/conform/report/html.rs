//! The report as one HTML page, with every frame behind its case.

use super::junit::escape;
use super::run::{self, Report, groups, millis};
use crate::conform::record::Record;

const STYLE: &str = "\
:root{color-scheme:light dark}\
body{font:16px/1.5 system-ui,sans-serif;max-width:70rem;margin:2rem auto;padding:0 1rem}\
h1{font-size:1.6rem}h2{font-size:1.2rem;margin-top:2rem}\
details{border-bottom:1px solid #8884;padding:.3rem 0}summary{cursor:pointer}\
.v{display:inline-block;width:5.5rem;font-weight:600}\
.pass .v{color:#1a7f37}.fail .v{color:#cf222e}.skipped .v,.na .v{color:#888}\
code{font-size:.9rem}pre{overflow:auto;background:#8881;padding:.5rem}\
table{border-collapse:collapse}td,th{padding:.2rem .8rem;text-align:left;border-bottom:1px solid #8884}";

pub(super) fn render(report: &Report) -> String {
    let title = format!("Conformance test of {}", escape(&report.device));
    let mut page = format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width\">\n<title>{title}</title>\n\
         <style>{STYLE}</style>\n</head>\n<body>\n<h1>{title}</h1>\n<p>Node {} on {}, against \
         <code>{}</code>.</p>\n<p>{}</p>\n",
        report.node,
        escape(&report.link),
        escape(&report.eds),
        escape(&report.summary())
    );
    if let Some(why) = &report.lost {
        page += &format!(
            "<p class=\"fail\"><strong>The run ended early: {}</strong></p>\n",
            escape(why)
        );
    }
    page += "<table>\n<tr><th>Time</th><th>Measured</th><th>50 %</th><th>95 %</th><th>Longest</th></tr>\n";
    for (name, count, all) in report.timings() {
        let [middle, most, longest] = all.map(millis);
        page += &format!(
            "<tr><td>{name}</td><td>{count}</td><td>{middle}</td><td>{most}</td><td>{longest}</td></tr>\n"
        );
    }
    page += "</table>\n";
    for (group, records) in groups(report) {
        page += &format!("<h2>{}</h2>\n", escape(group));
        for record in records {
            page += &case(record);
        }
    }
    page + "</body>\n</html>"
}

fn case(record: &Record) -> String {
    let word = record.verdict.word();
    let class = word.replace('/', "");
    let open = if record.verdict.is_fail() {
        " open"
    } else {
        ""
    };
    let mut text = format!(
        "<details class=\"{class}\"{open}><summary><span class=\"v\">{word}</span> \
         <code>{}</code> {}</summary>\n<p>{}",
        escape(&record.id),
        escape(&record.title),
        escape(&record.clause)
    );
    let reason = record.verdict.reason();
    if !reason.is_empty() {
        text += &format!("<br>{}", escape(&reason));
    }
    for note in &record.notes {
        text += &format!("<br>{}", escape(note));
    }
    let frames: Vec<String> = record.frames.iter().map(run::frame).collect();
    text += &format!(
        "</p>\n<pre>{}</pre>\n</details>\n",
        escape(&frames.join("\n"))
    );
    text
}
