//! Texts made to be slow or large: memory and time grow only with their length.

use std::collections::BTreeMap;

use od_eds::fix::{Applicability, fix};
use od_eds::{Document, Parsed, load, parse};

fn count(parsed: &Parsed, code: &str) -> usize {
    let all = parsed.findings.iter();
    all.filter(|finding| finding.code() == code).count()
}

/// `line(n)` for each n, behind `head`.
fn lines(head: &str, count: usize, line: impl Fn(usize) -> String) -> String {
    (0..count).fold(head.to_owned(), |mut text, n| {
        text.push_str(&line(n));
        text.push('\n');
        text
    })
}

const VAR: &str = "[2000]\nParameterName=a\nDataType=7\nAccessType=rw\n";

#[test]
fn tools_do_not_read_a_file_that_is_too_large() {
    let tools = od_eds::tools::TOOLS;
    for (text, is_compared) in [
        (lines(VAR, 49_000, |n| format!("[Own{n}]")), true),
        (lines(VAR, 51_000, |n| format!("[Own{n}]")), false),
        (lines(VAR, 201_000, |_| ";".into()), false),
        (format!("{VAR};{}", "a".repeat(2 << 20)), false),
    ] {
        let document = Document::new(text);
        assert_eq!(od_eds::tools::is_compared(&document), is_compared);
        let description = document.parse().description;
        let found = od_eds::tools::check(&document, &description, tools);
        assert_eq!(!found.is_empty(), is_compared);
    }
}

#[test]
fn findings_of_one_rule_are_counted_and_not_stored() {
    for (head, line, code) in [
        ("", "junk", "W0101"),
        ("", "=1", "W0102"),
        ("", "[x", "W0103"),
        ("", "[x] y", "W0104"),
        ("[FileInfo]\n", "FileName=1", "W0107"),
        ("[FileInfo]\n", "FileName:1", "W0108"),
        ("", "[]", "W0110"),
        (VAR, "[2000]", "W0304"),
        (VAR, "[2000]\nParameterName=b", "E0303"),
        ("", "[FileInfo]", "W0106"),
        (VAR, "[2001sub1]", "W0304"),
        ("[OptionalObjects]\n", "1=0x1005", "W0214"),
        (VAR, "; x\n[2000]\nOwn:1", "W0304"),
    ] {
        let parsed = load(&lines(head, 48_000, |_| line.into()));
        assert_eq!(count(&parsed, code), 10_000, "{line}");
        let more = parsed.findings.iter().filter(|f| f.code() == "W0116");
        let more: Vec<_> = more.map(|f| od_eds::say(f, &od_eds::Eds).message).collect();
        let own = more.iter().find(|said| said.starts_with(code));
        let own = own.unwrap_or_else(|| panic!("{line}: {more:?}"));
        let left: usize = own.split(' ').nth(2).and_then(|n| n.parse().ok()).unwrap();
        assert!((37_990..=38_000).contains(&left), "{own}");
    }
}

#[test]
fn sections_with_keys_of_their_own_are_joined() {
    let parsed = parse(&lines(VAR, 48_000, |n| format!("[2000]\nKey{n}=1")));
    let object = &parsed.description.objects[&0x2000];
    assert_eq!(object.entries[&0].extra.len(), 48_000);
    let text = lines("", 48_000, |n| format!("[Own{n}]\nA=1"));
    let canonical = od_eds::canonical(&parse(&text).description);
    assert!(canonical.contains("[Own0]\nA=1\n") && canonical.contains("[Own47999]\nA=1\n"));
}

#[test]
fn a_text_that_claims_millions_of_sub_objects_gets_fifty_thousand() {
    let array = |n: usize| {
        let index = 0x2000 + n;
        format!("[{index:04X}]\nObjectType=8\nDataType=5\nAccessType=ro\nCompactSubObj=254")
    };
    let parsed = parse(&lines("", 16_384, array));
    // Those beyond the limit of findings are counted.
    assert_eq!(count(&parsed, "E0353"), 10_000);
    let entries = parsed.description.entries().count();
    assert_eq!(entries, 16_384 + 50_000 / 254 * 254);
    // The object itself is kept.
    assert_eq!(parsed.description.objects.len(), 16_384);
    let parsed = parse(&lines("", 400, array));
    assert_eq!(count(&parsed, "E0353"), 400 - 50_000 / 254);
    assert_eq!(count(&parse(&lines("", 190, array)), "E0353"), 0);
}

/// Everything after the limit is ignored, and the finding is at the first ignored line.
#[test]
fn a_text_has_fifty_thousand_sections() {
    for (text, line, part) in [
        (
            lines("", 50_001, |n| format!("[Own{n}]")),
            50_001,
            "50000 sections",
        ),
        (
            lines("[Own]\n", 200_000, |n| format!("k{n}=1")),
            200_001,
            "200000 lines",
        ),
        (
            format!("{VAR}DefaultValue={}\n", "1".repeat(1 << 21)),
            5,
            "1048576 bytes",
        ),
    ] {
        let parsed = parse(&text);
        let found = parsed.findings.iter().find(|one| one.code() == "E0119");
        let found = found.unwrap_or_else(|| panic!("{part}"));
        assert_eq!(found.span().map(|span| span.line), Some(line), "{part}");
        let said = od_eds::say(found, &od_eds::Eds).message;
        assert!(said.contains(part), "{said}");
    }
    let most = lines("[Own]\n", 199_999, |n| format!("k{n}=1"));
    assert_eq!(count(&parse(&most), "E0119"), 0);
}

/// Processor time of this thread in hundredths of a second; `None` if the system does not provide
/// it.
fn processor_time() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/thread-self/stat").ok()?;
    let fields: Vec<&str> = text.rsplit(')').next()?.split_whitespace().collect();
    let number = |at: usize| fields.get(at)?.parse::<u64>().ok();
    Some(number(11)? + number(12)?)
}

/// Each text is larger than any device file. One is the largest file that odkit reads completely.
#[test]
fn time_grows_with_the_length_of_a_text() {
    let attributes = |sign: &str| -> String {
        let all: String = (0..300_000).map(|n| format!(" a{n}{sign}\"1\"")).collect();
        format!("<ISO15745ProfileContainer><a{all}/></ISO15745ProfileContainer>")
    };
    let long = |before: &str| format!("{VAR}{before}{}\n", "z".repeat(5_000_000));
    let noise: String = (0..500_000_u32)
        .map(|n| char::from((n.wrapping_mul(2_654_435_761) >> 25) as u8))
        .collect();
    let one_line: String = (0..20_000)
        .map(|n| {
            let index = 0x2000 + n;
            format!("<CANopenObject index=\"{index:04X}\" name=\"é\" objectType=\"7\"/>")
        })
        .collect();
    let references: String = (0..30_000)
        .map(|n| {
            let index = 0x2000 + n % 0x8000;
            format!("<CANopenObject index=\"{index:04X}\" objectType=\"7\" uniqueIDRef=\"P{n}\"/>")
        })
        .collect();
    let object = |n: usize| format!("[{:04X}]\nParameterName=a", 0x1000 + n % 0xF000);
    let sub = |n: usize| format!("[{:04X}sub{:X}]\nDataType=7", 0x2000 + n / 250, n % 250);
    for (name, text, code) in [
        ("300,000 attributes", attributes("="), "E0119"),
        ("300,000 attributes with blanks", attributes(" = "), "E0119"),
        (
            "300,000 elements inside each other",
            "<a>".repeat(300_000),
            "E0119",
        ),
        (
            "30,000 references to nothing",
            format!("<a>{references}</a>"),
            "E0115",
        ),
        ("objects in one line", format!("<a>{one_line}</a>"), "E0401"),
        ("a value of 5 MB", long("DefaultValue="), "E0119"),
        ("a header of 5 MB", long("["), "E0119"),
        ("a key of 5 MB", long(""), "E0119"),
        ("500 kB of noise", noise, "E0210"),
        ("200,000 sections", lines("", 200_000, object), "E0119"),
        ("200,000 sub-objects", lines("", 200_000, sub), "E0119"),
        (
            "200,000 own sections",
            lines("", 200_000, |n| format!("[Own{n}]\na=1")),
            "E0119",
        ),
        (
            "600,000 keys",
            lines(VAR, 600_000, |n| format!("k{n}=1")),
            "E0119",
        ),
    ] {
        let start = processor_time();
        let parsed = load(&text);
        // A build without optimisation needs ten times as long.
        let most = if cfg!(debug_assertions) { 2_000 } else { 200 };
        if let (Some(start), Some(end)) = (start, processor_time()) {
            assert!(end - start <= most, "{name}: {} ms", (end - start) * 10);
        }
        assert!(count(&parsed, code) > 0, "{name}: {code} is missing");
        // The findings of a rule differ in their numbers only: the first and each 50th show how long they are.
        let mut of_rule: BTreeMap<&str, usize> = BTreeMap::new();
        for finding in &parsed.findings {
            let number = of_rule.entry(finding.code()).or_default();
            *number += 1;
            if *number % 50 != 1 {
                continue;
            }
            let said = od_eds::say(finding, &od_eds::Eds);
            let length = said.message.chars().count().max(said.help.chars().count());
            assert!(
                length < 600,
                "{name}: {} has {length} characters",
                said.code
            );
        }
    }
}

/// An overlay as long as its base: sections and keys that change, that are new and that go.
#[test]
fn time_grows_with_the_length_of_an_overlay() {
    let own = |n: usize| format!("[Own{n}]\na=1");
    let base = lines("", 50_000, own);
    let keys = lines(VAR, 100_000, |n| format!("k{n}=1")) + &"\n".repeat(50_000);
    for (name, base, overlay, faults) in [
        ("changed sections", &base, lines("", 50_000, own), 0),
        (
            "removed sections",
            &base,
            lines("", 50_000, |n| format!("[Own{n}]\nRemove=1")),
            0,
        ),
        (
            "changed keys",
            &keys,
            lines(VAR, 100_000, |n| format!("k{}=2", 99_999 - n)),
            0,
        ),
        (
            "one section again and again",
            &keys,
            lines("", 50_000, |n| format!("[2000]\nnew{n}=2")),
            49_999,
        ),
    ] {
        let start = processor_time();
        let found = od_eds::overlay(base, &overlay).map_or_else(|faults| faults.len(), |_| 0);
        assert_eq!(found, faults, "{name}");
        let most = if cfg!(debug_assertions) { 2_000 } else { 200 };
        if let (Some(start), Some(end)) = (start, processor_time()) {
            assert!(end - start <= most, "{name}: {} ms", (end - start) * 10);
        }
    }
}

/// Each round makes 10,000 fixes of a rule; a file with more findings is fixed in parts.
#[test]
fn fixes_of_a_file_with_too_many_findings_end() {
    let text = lines("[FileInfo]\n", 60_000, |_| "FileName=1".into());
    let document = Document::new(text.into_bytes());
    let done = fix(&document, Applicability::Safe, |document| {
        document.load().findings
    });
    let left = done.document.text().matches("FileName=1").count();
    assert_eq!(left, 30_000);
}
