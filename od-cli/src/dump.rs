//! `odkit dump`: an object dictionary as a table.

use od_devices::sim::values;
use od_model::{Dictionary, Entry, Group, Kind, Literal, Tables, eds};

use crate::Failure;
use crate::output::Output;
use crate::source::Source;

/// Show an object dictionary
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
}

const HEAD: [&str; 9] = [
    "Index", "Sub", "Name", "Type", "Access", "PDO", "Default", "Limits", "Store",
];

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let Format::Table = args.format;
    let tables;
    let dictionary = match Source::find(&args.device)? {
        Source::BuiltIn(kind) => kind.dictionary,
        Source::File { path, text } => {
            let parsed = eds::parse(&text);
            tables = Tables::new(&parsed.description);
            let dictionary = tables.dictionary();
            if dictionary.objects().is_empty() {
                return Err(Failure::Failed(format!(
                    "{path} describes no object; is it an EDS or DCF file?"
                )));
            }
            dictionary
        }
    };
    let mut rows = vec![HEAD.map(String::from)];
    for object in dictionary.objects() {
        if object.code.has_members() {
            let mut row = HEAD.map(|_| String::new());
            row[0] = format!("{:04X}h", object.index);
            row[2] = dictionary.text(object.name).to_owned();
            row[3] = object.code.name().to_owned();
            rows.push(row);
        }
        for entry in dictionary.members(object) {
            rows.push(row(dictionary, entry, object.code.has_members()));
        }
    }
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max();
    let widths: Vec<usize> = (0..HEAD.len())
        .map(|column| width(column).unwrap_or(0))
        .collect();
    let mut output = Output::new();
    for row in &rows {
        let cells: Vec<String> = row
            .iter()
            .zip(&widths)
            .map(|(cell, width)| format!("{cell:<width$}"))
            .collect();
        if !output.line(cells.join("  ").trim_end())? {
            return Ok(());
        }
    }
    output.flush().map(|_| ())
}

fn row(dictionary: Dictionary<'_>, entry: &Entry, member: bool) -> [String; 9] {
    let show = |literal| literal_text(dictionary, entry, literal);
    let limits = match (show(entry.low), show(entry.high)) {
        (low, high) if low.is_empty() && high.is_empty() => String::new(),
        (low, high) => format!("{low}..{high}"),
    };
    let pdo = match (entry.maps_to_tpdo(), entry.maps_to_rpdo()) {
        (true, true) => "T R",
        (true, false) => "T",
        (false, true) => "R",
        (false, false) => "",
    };
    let group = match entry.group {
        Group::None => "",
        Group::Communication => "comm",
        Group::Application => "app",
        Group::Manufacturer => "manu",
    };
    let address = entry.address;
    [
        if member {
            String::new()
        } else {
            format!("{:04X}h", address.index)
        },
        format!("{:02X}", address.sub),
        format!(
            "{}{}",
            if member { "  " } else { "" },
            dictionary.text(entry.name)
        ),
        entry.data_type.name().to_owned(),
        entry.access.name().to_owned(),
        pdo.to_owned(),
        show(entry.default),
        limits,
        group.to_owned(),
    ]
}

/// Decimal where the number is small, hex where it is a code; as the manuals write them.
fn literal_text(dictionary: Dictionary<'_>, entry: &Entry, literal: Literal) -> String {
    match literal {
        Literal::None => String::new(),
        Literal::Unsigned(value) if entry.data_type.kind() == Kind::Boolean => {
            (value != 0).to_string()
        }
        Literal::Unsigned(value @ 0..=9) => value.to_string(),
        Literal::Unsigned(value) => format!("{value:X}h"),
        Literal::Signed(value) => value.to_string(),
        Literal::Real(value) => value.to_string(),
        Literal::NodeId(0) => "node ID".into(),
        Literal::NodeId(offset) => format!("{offset:X}h+node ID"),
        Literal::Text(range) => format!("{:?}", dictionary.text(range)),
        Literal::Bytes(range) => values::hex(dictionary.blob(range)),
    }
}
