//! `odkit dump`: an object dictionary as a table, or a device's datasheet.

use od_devices::text::datasheet;
use od_eds::convert::markdown::{self, HEAD};
use od_eds::{Description, Tables};
use od_model::Dictionary;

use crate::Failure;
use crate::output::Output;
use crate::source::Source;

/// Show an object dictionary, or a built-in device's datasheet
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Built-in device, or EDS or DCF file
    #[arg(value_name = "DEVICE|FILE")]
    device: String,
    /// How to show it
    #[arg(long, value_enum, default_value = "table")]
    format: Format,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum Format {
    /// Aligned columns
    Table,
    /// A page in Markdown: identity, what the device does, objects
    Md,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let (tables, description);
    let (dictionary, page) = match Source::find(&args.device)? {
        Source::BuiltIn(kind) => (kind.dictionary, datasheet::page(kind)),
        Source::File(file) => {
            description = file.parse()?.0;
            tables = Tables::new(&description);
            let dictionary = tables.dictionary();
            let title = product(&description).unwrap_or(&file.path).to_owned();
            (dictionary, markdown::page(&title, dictionary))
        }
    };
    let mut output = Output::new();
    let lines = match args.format {
        Format::Table => table(dictionary),
        Format::Md => page.lines().map(str::to_owned).collect(),
    };
    for line in lines {
        if !output.line(&line)? {
            return Ok(());
        }
    }
    output.flush().map(|_| ())
}

/// The name that a file gives its device.
fn product(description: &Description) -> Option<&str> {
    let info = description.section("DeviceInfo")?;
    let name = info.get("ProductName")?.trim();
    (!name.is_empty()).then_some(name)
}

fn table(dictionary: Dictionary<'_>) -> Vec<String> {
    let mut rows = vec![HEAD.map(String::from)];
    rows.extend(markdown::rows(dictionary).into_iter().map(|row| row.cells));
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max();
    let widths: Vec<usize> = (0..HEAD.len())
        .map(|column| width(column).unwrap_or(0))
        .collect();
    let line = |row: &[String; 9]| {
        let cells: Vec<String> = row
            .iter()
            .zip(&widths)
            .map(|(cell, width)| format!("{cell:<width$}"))
            .collect();
        cells.join("  ").trim_end().to_owned()
    };
    rows.iter().map(line).collect()
}
