//! The report as one HTML page, with the frames of each case after its result; it can be printed.

use super::run::{Narrator, Report, groups, millis, source};
use crate::conform::record::{Record, Verdict};
use crate::junit::escape;

const STYLE: &str = "\
:root{color-scheme:light dark}\
body{font:16px/1.5 system-ui,sans-serif;max-width:70rem;margin:2rem auto;padding:0 1rem}\
h1{font-size:1.6rem}h2{font-size:1.2rem;margin-top:2rem}\
details{border-bottom:1px solid #8884;padding:.3rem 0}summary{cursor:pointer}\
.v{display:inline-block;width:5.5rem;font-weight:600}\
.why{margin-left:5.5rem}\
.pass .v{color:#1a7f37}.fail .v{color:#cf222e}.skipped .v,.na .v{color:#888}\
code{font-size:.9rem}pre{overflow:auto;background:#8881;padding:.5rem}\
table{border-collapse:collapse}h2{break-after:avoid}\
@media print{:root{color-scheme:light}body{max-width:none;margin:0;font-size:10pt}details{break-inside:avoid-page}\
pre{white-space:pre-wrap;font-size:8pt}a{color:inherit;text-decoration:none}}\
td,th{padding:.2rem .8rem;text-align:left;border-bottom:1px solid #8884}";

pub(super) fn render(report: &Report) -> String {
    let title = format!("Conformance test of {}", escape(&report.device));
    let mut page = format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width\">\n<title>{title}</title>\n\
         <style>{STYLE}</style>\n</head>\n<body>\n<h1>{title}</h1>\n<p>{}</p>\n",
        escape(&report.summary())
    );
    if let Some(why) = &report.lost {
        page += &format!(
            "<p class=\"fail\"><strong>The run ended early: {}</strong></p>\n",
            escape(why)
        );
    }
    page += "<table>\n";
    for (name, value) in report.head() {
        page += &format!(
            "<tr><th>{}</th><td>{}</td></tr>\n",
            escape(name),
            escape(&value)
        );
    }
    page += "</table>\n<h2>Contents</h2>\n<table>\n<tr><th>Group</th><th>Passed</th><th>Failed</th>\
             <th>Skipped</th><th>Not applicable</th></tr>\n";
    for (number, (group, counts)) in report.by_group().into_iter().enumerate() {
        let name = escape(group);
        let name = match counts.pass + counts.skipped {
            0 => name,
            _ => format!("<a href=\"#g{number}\">{name}</a>"),
        };
        page += &format!(
            "<tr><td>{name}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
            counts.pass, counts.fail, counts.skipped, counts.not_applicable
        );
    }
    page += "</table>\n<p><a href=\"#failures\">Failures</a>, <a href=\"#times\">times</a>, \
             <a href=\"#na\">not applicable</a></p>\n<h2 id=\"failures\">Failures</h2>\n";
    let mut narrator = Narrator::new(report);
    if report.failures().next().is_none() {
        page += "<p>None.</p>\n";
    }
    for record in report.failures() {
        page += &case(record, &mut narrator);
    }
    page += "<h2 id=\"times\">Times</h2>\n<table>\n<tr><th>Time</th><th>Measured</th><th>50 %</th><th>95 %</th><th>Longest</th></tr>\n";
    for (name, count, all) in report.timings() {
        let [middle, most, longest] = all.map(millis);
        page += &format!(
            "<tr><td>{name}</td><td>{count}</td><td>{middle}</td><td>{most}</td><td>{longest}</td></tr>\n"
        );
    }
    page += "</table>\n";
    let is_na = |record: &Record| matches!(record.verdict, Verdict::NotApplicable(_));
    for (number, (group, mut records)) in groups(report).into_iter().enumerate() {
        records.retain(|record| !is_na(record) && !record.verdict.is_fail());
        if records.is_empty() {
            continue;
        }
        page += &format!("<h2 id=\"g{number}\">{}</h2>\n", escape(group));
        for record in records {
            page += &case(record, &mut narrator);
        }
    }
    page += "<h2 id=\"na\">Not applicable</h2>\n<table>\n";
    for record in report.records.iter().filter(|record| is_na(record)) {
        page += &format!(
            "<tr><td><code>{}</code></td><td>{}</td><td>{}</td></tr>\n",
            escape(&record.id),
            escape(&record.title),
            escape(&record.verdict.reason())
        );
    }
    page + "</table>\n</body>\n</html>"
}

fn case(record: &Record, narrator: &mut Narrator) -> String {
    let word = record.verdict.word();
    let open = if record.verdict.is_fail() {
        " open"
    } else {
        ""
    };
    // The reason is in the summary: a page of closed cases, as it is printed, tells why one was skipped.
    let reason = match record.verdict.reason() {
        reason if reason.is_empty() => reason,
        reason => format!("<br><span class=\"why\">{}</span>", escape(&reason)),
    };
    let mut text = format!(
        "<details class=\"{word}\"{open}><summary><span class=\"v\">{word}</span> \
         <code>{}</code> {}{reason}</summary>\n<p>{}",
        escape(&record.id),
        escape(&record.title),
        escape(&source(record))
    );
    for note in &record.notes {
        text += &format!("<br>{}", escape(note));
    }
    text += "</p>\n";
    let frames = narrator.lines(record);
    if !frames.is_empty() {
        text += &format!("<pre>{}</pre>\n", escape(&frames.join("\n")));
    }
    text + "</details>\n"
}
