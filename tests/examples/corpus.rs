//! Results of odkit for a folder of device files: `cargo xtask corpus DIR`.
//!
//! ```text
//! corpus DIR               a line a file, then the sums
//! corpus DIR --docs FILE   the sums as Markdown
//! corpus DIR --entries     every value as a line of tab-separated fields, for comparisons
//! corpus DIR --time        parse and check all files, ten times at least; the best counts
//! ```

mod folder;

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::{Duration, Instant};
use std::{env, fs};

use od_eds::check;
use od_eds::check::RULES;
use od_eds::{Document, Parsed};
use od_eds::{Severity, Value};

fn main() -> ExitCode {
    let args: Vec<String> = env::args().skip(1).collect();
    let (folder, what, file) = match args.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        [folder] => (folder, "", ""),
        [folder, "--docs", file] => (folder, "--docs", file),
        [folder, what @ ("--entries" | "--time")] => (folder, what, ""),
        _ => {
            eprintln!("usage: corpus DIR [--docs FILE | --entries | --time]");
            return ExitCode::from(2);
        }
    };
    let files = match folder::files(Path::new(folder), &["eds", "dcf", "xdd", "xdc", "xpd"]) {
        Ok(files) => files,
        Err(error) => {
            eprintln!("{folder}: {error}");
            return ExitCode::FAILURE;
        }
    };
    let files: Vec<File> = files
        .into_iter()
        .filter_map(|path| File::read(Path::new(folder), path))
        .collect();
    if files.is_empty() {
        eprintln!("{folder} contains no EDS, DCF, XDD, XDC or XPD file");
        return ExitCode::FAILURE;
    }
    let text = match what {
        "--entries" => entries(&files),
        "--time" => time(&files),
        "--docs" => {
            if let Err(error) = fs::write(file, docs(&files)) {
                eprintln!("{file}: {error}");
                return ExitCode::FAILURE;
            }
            sums(&files)
        }
        _ => {
            let lines: Vec<String> = files.iter().map(File::line).collect();
            format!("{}\n\n{}", lines.join("\n"), sums(&files))
        }
    };
    // A reader such as `head` may stop early.
    let _ = std::io::stdout().write_all(text.as_bytes());
    ExitCode::SUCCESS
}

/// A file with its results.
struct File {
    /// Path relative to the corpus.
    name: String,
    bytes: usize,
    document: Document,
    loaded: Parsed,
    /// Parse and check of one run.
    time: Duration,
}

impl File {
    fn read(root: &Path, path: PathBuf) -> Option<Self> {
        let bytes = fs::read(&path).ok()?;
        let length = bytes.len();
        let start = Instant::now();
        let document = Document::new(bytes).named(path.display().to_string());
        let loaded = document.load();
        let time = start.elapsed();
        let name = path.strip_prefix(root).unwrap_or(&path);
        Some(Self {
            name: name.display().to_string().replace('\\', "/"),
            bytes: length,
            document,
            loaded,
            time,
        })
    }

    fn objects(&self) -> usize {
        self.loaded.description.objects.len()
    }

    fn entries(&self) -> usize {
        self.loaded.description.entries().count()
    }

    fn loads(&self) -> bool {
        self.objects() > 0
    }

    fn codes(&self) -> BTreeMap<&'static str, usize> {
        let mut codes = BTreeMap::new();
        for finding in &self.loaded.findings {
            *codes.entry(finding.code()).or_default() += 1;
        }
        codes
    }

    fn line(&self) -> String {
        let mut line = format!(
            "{}: {}, {} objects, {} values",
            self.name,
            if self.loads() {
                "loads"
            } else {
                "holds no object"
            },
            self.objects(),
            self.entries()
        );
        for (code, count) in self.codes() {
            let _ = write!(line, ", {code} {count}");
        }
        line
    }
}

/// Files and findings by code.
fn by_code(files: &[File]) -> BTreeMap<&'static str, (usize, usize)> {
    let mut all: BTreeMap<&str, (usize, usize)> = BTreeMap::new();
    for file in files {
        for (code, count) in file.codes() {
            let (files, findings) = all.entry(code).or_default();
            *files += 1;
            *findings += count;
        }
    }
    all
}

fn sums(files: &[File]) -> String {
    let mut text = String::new();
    let loading = files.iter().filter(|file| file.loads()).count();
    let bytes: usize = files.iter().map(|file| file.bytes).sum();
    let time: Duration = files.iter().map(|file| file.time).sum();
    let slowest = files.iter().max_by_key(|file| file.time);
    let _ = writeln!(
        text,
        "{} files, {loading} load: {} objects, {} values; {} kB in {:.0} ms",
        files.len(),
        files.iter().map(File::objects).sum::<usize>(),
        files.iter().map(File::entries).sum::<usize>(),
        bytes / 1000,
        time.as_secs_f64() * 1e3,
    );
    if let Some(file) = slowest {
        let ms = file.time.as_secs_f64() * 1e3;
        let _ = writeln!(text, "slowest: {} with {ms:.1} ms", file.name);
    }
    let _ = writeln!(text, "\ncode   files  findings");
    for (code, (files, findings)) in by_code(files) {
        let title = check::rule(code).map_or("", |rule| rule.title);
        let _ = writeln!(text, "{code}  {files:5}  {findings:8}  {title}");
    }
    text
}

fn docs(files: &[File]) -> String {
    let mut text = String::from(
        "# The corpus\n\n\
         What odkit makes of the device files that were collected from public repositories: EDS, DCF, XDD and\n\
         project files of some thirty vendors and tools. The files are not part of odkit. This page is made by\n\
         `cargo xtask corpus DIR --docs docs/CORPUS.md`; how odkit's reading differs from python-canopen's, and\n\
         who is right, is in [DIFFERENCES.md](DIFFERENCES.md).\n\n",
    );
    let loading = files.iter().filter(|file| file.loads()).count();
    let clean = |file: &&File| {
        let mut findings = file.loaded.findings.iter();
        !findings.any(od_eds::Finding::is_error)
    };
    let _ = writeln!(
        text,
        "**{} files; {loading} load, with {} objects and {} values; {} have no error.**\n",
        files.len(),
        files.iter().map(File::objects).sum::<usize>(),
        files.iter().map(File::entries).sum::<usize>(),
        files.iter().filter(clean).count(),
    );
    text.push_str("## By repository\n\n| repository | files | load | objects | values | errors | warnings | remarks |\n|---|--:|--:|--:|--:|--:|--:|--:|\n");
    let mut folders: BTreeMap<&str, Vec<&File>> = BTreeMap::new();
    for file in files {
        let folder = file.name.split('/').next().unwrap_or_default();
        folders.entry(folder).or_default().push(file);
    }
    for (folder, files) in folders {
        let count = |severity| {
            let findings = files.iter().flat_map(|file| &file.loaded.findings);
            findings
                .filter(|finding| finding.severity() == severity)
                .count()
        };
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | {} | {} | {} | {} |",
            folder.replace("__", "/"),
            files.len(),
            files.iter().filter(|file| file.loads()).count(),
            files.iter().map(|file| file.objects()).sum::<usize>(),
            files.iter().map(|file| file.entries()).sum::<usize>(),
            count(Severity::Error),
            count(Severity::Warning),
            count(Severity::Info),
        );
    }
    text.push_str("\n## By code\n\n| code | what | files | findings |\n|---|---|--:|--:|\n");
    let found = by_code(files);
    for rule in RULES {
        if let Some((files, findings)) = found.get(rule.code) {
            let _ = writeln!(
                text,
                "| {} | {} | {files} | {findings} |",
                rule.code, rule.title
            );
        }
    }
    text
}

/// Every value, one per line: file, index, sub-index, object code, type code, access,
/// mappable, default, low, high, configured value, name.
fn entries(files: &[File]) -> String {
    let mut text = String::new();
    for file in files {
        let _ = writeln!(text, "{}", file.name);
        for (index, object) in &file.loaded.description.objects {
            let code = object.code.code();
            let name = object.name.escape_default();
            let _ = writeln!(text, "\t{index:04X}\t{code}\t{name}");
            for (sub, entry) in &object.entries {
                let data_type = entry.data_type.map_or(0, |t| t.code());
                let _ = write!(
                    text,
                    "\t{index:04X}\t{sub:02X}\t{data_type}\t{}\t{}",
                    entry.access.name(),
                    u8::from(*entry.mappable),
                );
                for value in [&entry.default, &entry.low, &entry.high, &entry.parameter] {
                    let value = value.as_ref().map(|value| shown(&value.value));
                    let _ = write!(text, "\t{}", value.unwrap_or_default());
                }
                let _ = writeln!(text, "\t{}", entry.name.escape_default());
            }
        }
    }
    text
}

fn shown(value: &Value) -> String {
    match value {
        Value::Unsigned(number) => format!("i{number}"),
        Value::Signed(number) => format!("i{number}"),
        Value::Real(number) => format!("r{number:?}"),
        Value::NodeId(offset) => format!("n{offset}"),
        Value::Text(text) => format!("t{}", text.escape_default()),
        Value::Bytes(bytes) => {
            let hex: String = bytes.iter().map(|byte| format!("{byte:02X}")).collect();
            format!("b{hex}")
        }
    }
}

/// Seconds for the corpus, and for its slowest file: the best of several rounds.
fn time(files: &[File]) -> String {
    let contents: Vec<(&str, Vec<u8>)> = files
        .iter()
        .map(|file| (file.name.as_str(), file.document.bytes().to_vec()))
        .collect();
    let mut best = f64::INFINITY;
    let mut each = vec![f64::INFINITY; contents.len()];
    let end = Instant::now() + Duration::from_secs(2);
    let mut rounds = 0;
    // On a busy machine two seconds may be one interrupted round.
    while rounds < 10 || Instant::now() < end {
        rounds += 1;
        let round = Instant::now();
        for ((_, bytes), best) in contents.iter().zip(&mut each) {
            let start = Instant::now();
            let loaded = Document::new(bytes.clone()).load();
            *best = best.min(start.elapsed().as_secs_f64());
            assert!(!loaded.description.objects.is_empty() || !loaded.findings.is_empty());
        }
        best = best.min(round.elapsed().as_secs_f64());
    }
    let size: usize = contents.iter().map(|(_, bytes)| bytes.len()).sum();
    let mut text = format!("corpus\t{size}\t{best}\n");
    for ((name, bytes), best) in contents.iter().zip(each) {
        let _ = writeln!(text, "{name}\t{}\t{best}", bytes.len());
    }
    text
}
