//! Logs that odkit does not read: their names, and the programs that convert them.

/// Lines in which a text shows its kind.
const HEAD: usize = 20;

/// Texts of other logs: the beginning of a line in lower case, name, and the way to a log that odkit reads.
const TEXTS: [(&str, &str, &str); 4] = [
    (
        "***busmaster",
        "a BUSMASTER log",
        "BUSMASTER converts it to ASC (format converter, `Log to ASC`)",
    ),
    (
        "timestamp,arbitration_id,",
        "a CSV log of python-can",
        "`can_logconvert` of python-can turns it into a candump log (`can_logconvert FILE.csv FILE.log`)",
    ),
    (
        "time   id     dlc data",
        "a trace of CANHacker",
        "SavvyCAN opens it and saves it as a candump log",
    ),
    (
        "no.     time  ",
        "a text of Wireshark, which lacks the bytes of the frames",
        "save the capture as pcapng (`File`, `Save As`)",
    ),
];

/// First bytes of other logs, name, and the way to a log that odkit reads.
const BINARIES: [(&[u8], &str, &str); 2] = [
    (
        b"MDF     ",
        "an MDF log (MF4)",
        "export it as ASC, with the program that wrote it or with `mdf2asc`",
    ),
    (
        b"SQLite format 3",
        "a database, such as python-can writes",
        "`can_logconvert` of python-can turns it into a candump log (`can_logconvert FILE.db FILE.log`)",
    ),
];

/// Returns what a file is and how to convert it, if it is a known log that odkit does not read.
pub(super) fn name(bytes: &[u8]) -> Option<String> {
    let said = |name, way| format!("it is {name}, which odkit does not read; {way}");
    let binary = BINARIES.iter().find(|(start, ..)| bytes.starts_with(start));
    if let Some((_, name, way)) = binary {
        return Some(said(name, way));
    }
    let text = String::from_utf8_lossy(&bytes[..bytes.len().min(4096)]).to_lowercase();
    let lines = text.trim_start_matches('\u{feff}').lines().take(HEAD);
    let mut known = lines.filter_map(|line| {
        let is_one = |(start, ..): &&(&str, _, _)| line.trim_start().starts_with(start);
        TEXTS.iter().find(is_one)
    });
    known.next().map(|(_, name, way)| said(name, way))
}
