//! `odkit dump`: an object dictionary as a table, or a device's datasheet.

use od_devices::text::datasheet;
use od_eds::convert::markdown::{self, HEAD};
use od_eds::{Description, Tables};
use od_model::Dictionary;

use crate::failure::Failure;
use crate::output;
use crate::source::Source;

/// Show an object dictionary, or a built-in device's datasheet
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Built-in device, or EDS or DCF file
    #[arg(value_name = "DEVICE|FILE")]
    device: String,
    /// Format of the output
    #[arg(long, value_enum, default_value = "table")]
    format: Format,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum Format {
    /// Aligned columns
    Table,
    /// Datasheet in Markdown: identity, functions, objects
    Md,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let source = Source::find(&args.device)?;
    let description = source.parse()?.description;
    let tables = Tables::new(&description);
    output::print(&match (args.format, source.kind) {
        (Format::Table, _) => table(tables.dictionary()),
        (Format::Md, Some(kind)) => datasheet::page(kind),
        (Format::Md, None) => {
            let title = product(&description).unwrap_or(&source.path);
            markdown::page(title, tables.dictionary())
        }
    })
}

/// The name of the device in its file.
fn product(description: &Description) -> Option<&str> {
    let info = description.section("DeviceInfo")?;
    let name = info.get("ProductName")?.trim();
    (!name.is_empty()).then_some(name)
}

fn table(dictionary: Dictionary<'_>) -> String {
    let mut rows = vec![HEAD.map(String::from)];
    rows.extend(markdown::rows(dictionary).into_iter().map(|row| row.cells));
    let mut widths = [0; HEAD.len()];
    for row in &rows {
        for (width, cell) in widths.iter_mut().zip(row) {
            *width = cell.chars().count().max(*width);
        }
    }
    let line = |row: &[String; HEAD.len()]| {
        let cells = row.iter().zip(widths);
        let cells: Vec<String> = cells
            .map(|(cell, width)| format!("{cell:<width$}"))
            .collect();
        cells.join("  ").trim_end().to_owned()
    };
    rows.iter().map(line).collect::<Vec<_>>().join("\n")
}
