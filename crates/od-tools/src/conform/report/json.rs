//! The report as one JSON object.

use od_model::Visible;
use serde_json::{Value, json};

use super::run::{Narrator, Report};
use crate::conform::official::numbers;
use crate::conform::record::{Record, Verdict};

pub(super) fn render(report: &Report) -> String {
    let counts = report.counts();
    let mut narrator = Narrator::new(report);
    let timings: Vec<Value> = report
        .timings()
        .into_iter()
        .map(|(name, count, [middle, most, longest])| {
            json!({
                "name": name, "count": count,
                "p50_us": middle, "p95_us": most, "max_us": longest,
            })
        })
        .collect();
    let value = json!({
        "device": report.device,
        "eds": report.eds,
        "link": report.link,
        "node": report.node,
        "about": report.head().into_iter().map(|(name, value)| (name.to_owned(), Value::from(value))).collect::<serde_json::Map<_, _>>(),
        "pass": report.is_pass(),
        "lost": report.lost,
        "counts": {
            "pass": counts.pass,
            "fail": counts.fail,
            "skipped": counts.skipped,
            "not_applicable": counts.not_applicable,
        },
        "timings": timings,
        "cases": report.records.iter().map(|record| case(record, &mut narrator)).collect::<Vec<_>>(),
    });
    Visible(&format!("{value:#}")).json().into_owned()
}

fn case(record: &Record, narrator: &mut Narrator) -> Value {
    let (expected, got, reason) = match &record.verdict {
        Verdict::Pass => (None, None, None),
        Verdict::Fail { expected, got } => (Some(expected), Some(got), None),
        Verdict::Skipped(why) | Verdict::NotApplicable(why) => (None, None, Some(why)),
    };
    let frames: Vec<Value> = record
        .frames
        .iter()
        .map(|traced| {
            json!({
                "us": traced.at.as_micros(),
                "from": if traced.ours { "test" } else { "bus" },
                "frame": traced.frame.to_string(),
                "words": narrator.words(traced),
            })
        })
        .collect();
    json!({
        "id": record.id,
        "group": record.group,
        "clause": record.clause,
        "official": numbers(&record.id),
        "title": record.title,
        "verdict": record.verdict.word(),
        "expected": expected,
        "got": got,
        "reason": reason,
        "notes": record.notes,
        "us": record.micros,
        "frames": frames,
    })
}
