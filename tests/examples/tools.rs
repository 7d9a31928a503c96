//! Prints what odkit expects of the tools that read device files, for comparison with the tools.
//!
//! ```text
//! tools mutants DIR OUT COUNT SEED    COUNT changed copies of the EDS and DCF files below DIR, in OUT
//! tools verdicts TOOL DIR             a line a file: its path, the verdict, the codes, the first message
//! tools readings TOOL DIR             the same, and every value that the tool reads as a line of fields
//! ```

mod folder;

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::Path;
use std::process::ExitCode;
use std::{env, fs, io};

use od_eds::tools::{self, Read, Tool};
use od_eds::{Document, Eds, say};
use od_fuzz::mutate;
use od_fuzz::random::Random;
use od_fuzz::target::Target;
use od_fuzz::targets::ALL;

fn main() -> ExitCode {
    let args: Vec<String> = env::args().skip(1).collect();
    let done = match args.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["mutants", from, to, count, seed] => mutants(Path::new(from), Path::new(to), count, seed),
        [what @ ("verdicts" | "readings"), tool, folder] => {
            let Some(tool) = tools::tool(tool) else {
                eprintln!("{tool} is not the name of a tool");
                return ExitCode::from(2);
            };
            report(tool, Path::new(folder), what == "readings")
        }
        _ => {
            eprintln!("usage: tools mutants DIR OUT COUNT SEED | tools verdicts|readings TOOL DIR");
            return ExitCode::from(2);
        }
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

/// Most mutants have a few changes of one file, some a part of another.
fn mutants(from: &Path, to: &Path, count: &str, seed: &str) -> io::Result<()> {
    let wrong = |_| io::Error::other("COUNT and SEED are numbers");
    let count: u64 = count.parse().map_err(wrong)?;
    let seed: u64 = seed.parse().map_err(wrong)?;
    let paths = folder::files(from, &["eds", "dcf"])?;
    let seeds: Vec<Vec<u8>> = paths.iter().map(fs::read).collect::<io::Result<_>>()?;
    let eds = ALL.iter().find(|target| target.name == "eds");
    let target = Target {
        longest: usize::MAX,
        ..*eds.ok_or_else(|| io::Error::other("target `eds` does not exist"))?
    };
    fs::create_dir_all(to)?;
    for number in 0..count {
        let mut random = Random::of(seed, number);
        let bytes = mutate::input(&target, &seeds, &mut random);
        fs::write(to.join(format!("{number:05}.eds")), bytes)?;
    }
    Ok(())
}

fn report(tool: &'static Tool, folder: &Path, with_values: bool) -> io::Result<()> {
    let mut out = String::new();
    for path in folder::files(folder, &["eds", "dcf", "xdd", "xdc", "xpd"])? {
        let document = Document::new(fs::read(&path)?);
        let description = document.parse().description;
        let findings = tools::check(&document, &description, &[tool]);
        let name = path.strip_prefix(folder).unwrap_or(&path).display();
        let verdict = tools::verdict(&findings).name();
        let first = findings.first().map(|finding| say(finding, &Eds));
        let codes: Vec<&str> = findings.iter().map(od_eds::Finding::code).collect();
        let first = first.map_or(String::new(), |it| {
            format!(
                "{}: {}",
                it.span.map_or(0, |span| span.line),
                it.message.escape_debug()
            )
        });
        let _ = writeln!(out, "{name}\t{verdict}\t{}\t{first}", codes.join(","));
        if with_values {
            values(&document, tool, &mut out);
        }
        io::stdout().write_all(out.as_bytes())?;
        out.clear();
    }
    Ok(())
}

/// Index, sub-index, type, access, mapping, default, low, high, value and name; `-` for what the tool lacks.
fn values(document: &Document, tool: &Tool, out: &mut String) {
    let reading = tools::reading(document, tool);
    if reading.is_rejected() {
        return;
    }
    let or = |text: Option<String>| text.unwrap_or_else(|| "-".into());
    for ((index, sub), entry) in &reading.entries {
        let data_type = or(entry.data_type.map(|it| it.to_string()));
        let access = or(entry.access.as_ref().map(|it| escaped(it)));
        let mapping = or(entry.mappable.map(|it| u8::from(it).to_string()));
        let values = [&entry.default, &entry.low, &entry.high, &entry.parameter];
        let [default, low, high, value] =
            values.map(|it| or(it.as_ref().map(|it| shown(it.as_ref()))));
        let name = or(entry.name.as_ref().map(|it| format!("t{}", escaped(it))));
        let _ = writeln!(
            out,
            "\t{index:04X}\t{sub:X}\t{data_type}\t{access}\t{mapping}\t{default}\t{low}\t{high}\t{value}\t{name}"
        );
    }
}

fn escaped(text: &str) -> String {
    text.escape_default().to_string()
}

fn shown(value: Option<&Read>) -> String {
    match value {
        None => String::new(),
        Some(Read::Number(number)) => format!("i{number}"),
        Some(Read::Real(real)) => format!("r{real:?}"),
        Some(Read::Text(text)) => format!("t{}", escaped(text)),
        Some(Read::Bytes(bytes)) => bytes
            .iter()
            .fold("b".into(), |out, byte| format!("{out}{byte:02x}")),
    }
}
