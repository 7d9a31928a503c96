//! Logs that odkit does not read: their names, and the programs that convert them.

/// Number of lines at the start of a text that are searched.
const HEAD: usize = 20;

/// Text logs: how a line begins (lower case), the name of the log, and how to get a log that odkit reads.
const TEXTS: [(&str, &str, &str); 6] = [
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
    (
        "frame 1: ",
        "a text of Wireshark that describes one packet in words",
        "save the capture as pcapng (`File`, `Save As`)",
    ),
    (
        "0000  ",
        "a dump of bytes, as tshark and Wireshark print it",
        "`text2pcap -l 227 FILE OUT.pcap` turns it into a capture",
    ),
    (
        "can-id;type;length;",
        "the list of received messages of PCAN-View, which has no times",
        "record a trace (page `Trace`) and save it as TRC",
    ),
    (
        "microchip technology inc.",
        "a log of the Microchip CAN Bus Analyzer",
        "SavvyCAN opens it and saves it as a candump log",
    ),
];

/// As [`TEXTS`], but the words may be anywhere in a line.
const WORDS: [(&str, &str, &str); 3] = [
    (
        "< cansniffer ",
        "the screen of `cansniffer`, which shows only the last bytes of a CAN-ID",
        "`candump -L` records every frame",
    ),
    (
        " cxx info type:crtd",
        "a CRTD log",
        "SavvyCAN opens it and saves it as a candump log",
    ),
    (
        "), length: ",
        "a text of Wireshark or tshark, which lacks the bytes of the frames",
        "save the capture as pcapng (`File`, `Save As`; `tshark -w`)",
    ),
];

/// Binary logs: their first bytes, the name of the log, and how to get a log that odkit reads.
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
        let has = |(word, ..): &&(&str, _, _)| line.contains(word);
        let known = TEXTS.iter().find(is_one);
        known.or_else(|| WORDS.iter().find(has))
    });
    known.next().map(|(_, name, way)| said(name, way))
}
