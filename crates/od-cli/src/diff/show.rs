//! Differences as text, JSON and Markdown.

use od_eds::diff::{Difference, Field, Impact};

use od_model::Visible;

use crate::failure::Failure;
use crate::{output, report};

#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(super) enum Format {
    /// A line for each difference: `+` added, `-` removed, `~` changed, `!` breaking
    Text,
    /// One JSON object
    Json,
    /// A table for a release note
    Markdown,
}

pub(super) fn print(
    format: Format,
    titles: &[String; 2],
    found: &[Difference],
) -> Result<(), Failure> {
    output::print(&match format {
        Format::Text => text(titles, found),
        Format::Json => json(titles, found),
        Format::Markdown => markdown(titles, found),
    })
}

fn breaking(found: &[Difference]) -> usize {
    let breaks = |difference: &&Difference| difference.impact == Impact::Breaking;
    found.iter().filter(breaks).count()
}

fn summary(found: &[Difference]) -> String {
    if found.is_empty() {
        return "no difference".into();
    }
    let count = report::plural(found.len(), "difference");
    match breaking(found) {
        0 => format!("{count}, none breaking"),
        breaking => format!("{count}, {breaking} breaking"),
    }
}

fn text(titles: &[String; 2], found: &[Difference]) -> String {
    let mut lines = Vec::new();
    let width = found.iter().map(|d| d.place().len()).max().unwrap_or(0);
    for difference in found {
        let sign = match difference.field {
            Field::ObjectAdded | Field::EntryAdded => '+',
            Field::ObjectRemoved | Field::EntryRemoved => '-',
            _ => '~',
        };
        let mark = match difference.impact {
            Impact::Breaking => '!',
            Impact::Compatible => ' ',
        };
        let place = difference.place();
        let name = Visible(&difference.name);
        lines.push(format!(
            "{mark}{sign} {place:<width$}  {name}: {}",
            difference.change()
        ));
    }
    lines.push(format!(
        "{} -> {}: {}",
        Visible(&titles[0]),
        Visible(&titles[1]),
        summary(found)
    ));
    lines.join("\n")
}

fn markdown(titles: &[String; 2], found: &[Difference]) -> String {
    let cell = |text: &str| Visible(text).markdown();
    let mut lines = vec![
        format!("## {} → {}", cell(&titles[0]), cell(&titles[1])),
        String::new(),
        format!("{}.", summary(found)),
    ];
    if !found.is_empty() {
        lines.push(String::new());
        lines.push("| Object | Name | What | Before | After | |".into());
        lines.push("|---|---|---|---|---|---|".into());
    }
    for difference in found {
        let impact = match difference.impact {
            Impact::Breaking => "**breaking**",
            Impact::Compatible => "",
        };
        lines.push(format!(
            "| {} | {} | {} | {} | {} | {impact} |",
            difference.place(),
            cell(&difference.name),
            difference.field.name(),
            cell(&difference.before),
            cell(&difference.after),
        ));
    }
    lines.join("\n")
}

fn json(titles: &[String; 2], found: &[Difference]) -> String {
    let value = serde_json::json!({
        "before": titles[0],
        "after": titles[1],
        "breaking": breaking(found),
        "differences": found,
    });
    format!("{value:#}")
}
