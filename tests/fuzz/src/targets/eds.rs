//! EDS and DCF text: any text is read, a written text reads the same, and its valid part runs
//! as a device.

use od_eds::{Description, Document, Eds, Finding, Parsed, Tables, check, say};
use od_runtime::{Frame, Instant};
use od_sim::{Bus, EdsOptions, VirtualDevice};

use crate::files::files;
use crate::sent::owner;
use crate::target::Target;

/// The target.
pub const TARGET: Target = Target {
    name: "eds",
    run,
    seeds,
    words: WORDS,
    is_text: true,
    longest: 32_768,
    ..Target::PLAIN
};

/// EDS and DCF files of the project.
pub(super) fn seeds() -> Vec<Vec<u8>> {
    let mut seeds = files("tests/cases", &["input.eds", "input.dcf"], 16_384);
    for folder in [
        "tests/eds",
        "tests/interop",
        "tests/corpus",
        "crates/od-eds/cases",
    ] {
        seeds.extend(files(folder, &[".eds", ".dcf"], 16_384));
    }
    assert!(seeds.len() > 10, "where are the cases?");
    seeds
}

/// Words of the language.
pub(super) const WORDS: &[&str] = &[
    "[1000]\n",
    "[1018sub1]\n",
    "[1A00]\n",
    "[1A00sub0]\n",
    "[1A00sub1]\n",
    "[2000]\n",
    "[FFFF]\n",
    "[1003]\n",
    "[1003Name]\n",
    "[1003Value]\n",
    "[DeviceComissioning]\n",
    "[FileInfo]\n",
    "[DummyUsage]\n",
    "[Comments]\n",
    "ParameterName=x\n",
    "ObjectType=0x9\n",
    "ObjectType=0x8\n",
    "SubNumber=255\n",
    "CompactSubObj=254\n",
    "DataType=0x0007\n",
    "DataType=0x001B\n",
    "DataType=0x000F\n",
    "AccessType=const\n",
    "AccessType=rww\n",
    "DefaultValue=$NODEID+0x180\n",
    "LowLimit=-1\n",
    "HighLimit=0xFFFFFFFFFFFFFFFF\n",
    "PDOMapping=1\n",
    "ParameterValue=5\n",
    "NodeID=127\n",
    ";StorageLocation=PERSIST_APP\n",
    "SupportedObjects=65535\n",
    "=",
    "\r\n",
    "\u{feff}",
    "\u{ff}",
    "ä",
    "[",
    "]",
    ";",
    "\"",
];

fn run(input: &[u8]) {
    let document = Document::new(input);
    read_again(&document);
    let text = document.text();
    let options = EdsOptions {
        lenient: true,
        ..EdsOptions::default()
    };
    let Ok(device) = VirtualDevice::from_eds(text, options) else {
        return;
    };
    let mut bus = Bus::new();
    let number = bus.add(device);
    bus.start(number);
    let node = bus.devices()[0].node_id().raw();
    bus.receive(&Frame::standard(0, &[1, node]));
    let entries: Vec<_> = bus.devices()[0]
        .dictionary()
        .entries()
        .iter()
        .map(|entry| entry.address)
        .collect();
    for address in entries.into_iter().take(50) {
        let [low, high] = address.index.to_le_bytes();
        let request = [0x40, low, high, address.sub, 0, 0, 0, 0];
        bus.receive(&Frame::standard(0x600 + u16::from(node), &request));
    }
    bus.receive(&Frame::standard(0x80, &[]));
    let own = bus.devices()[0].node_id();
    let mut count = 0;
    while let Some(sent) = bus.poll() {
        owner(own, &sent.frame);
        count += 1;
    }
    assert!(count < 1000, "{count} answers to 52 frames");
    bus.advance(Instant::ZERO.plus_millis(20));
    while let Some(sent) = bus.poll() {
        owner(own, &sent.frame);
    }
    bus.with(number, VirtualDevice::power_off);
}

/// Reads a text, and checks what holds for each text.
///
/// # Panics
/// If a property does not hold.
pub fn read_again(document: &Document) -> Parsed {
    let loaded = document.load();
    let mut unedited = document.clone();
    assert!(unedited.apply(&[]).is_ok());
    assert!(unedited == *document, "an unedited document differs");
    written_again(&loaded.description);
    let tables = Tables::new(&loaded.description);
    let dictionary = tables.dictionary();
    for entry in dictionary.entries() {
        assert_eq!(dictionary.find(entry.address), Ok(entry));
    }
    said(&loaded.findings, document.text());
    loaded
}

/// A written description reads the same, and each form of it is written the same again.
pub(super) fn written_again(description: &Description) {
    let written = od_eds::write(description);
    let again = od_eds::parse(&written).description;
    same(description, &again, &written);
    let mut rest = description.clone();
    rest.objects.clone_from(&again.objects);
    assert!(
        rest == again,
        "not only objects differ: {rest:#?} is now {again:#?} in\n{written}"
    );
    for write in [od_eds::write, od_eds::canonical] {
        let once = write(&again);
        let twice = write(&od_eds::parse(&once).description);
        assert!(
            twice == once,
            "written again, the text differs:\n{once}\n{twice}"
        );
    }
}

/// Like [`same`], without values that could not be parsed and stayed text.
pub(super) fn same_values(before: &Description, after: &Description, written: &str) {
    let valid = |description: &Description| {
        let mut valid = description.clone();
        for object in valid.objects.values_mut() {
            object.extra.clear();
            object
                .entries
                .values_mut()
                .for_each(|entry| entry.extra.clear());
        }
        valid
    };
    same(&valid(before), &valid(after), written);
}

/// Both have the same objects. A writer counts sub-objects that were not counted.
pub(super) fn same(before: &Description, after: &Description, written: &str) {
    for (index, object) in &before.objects {
        let again = after.objects.get(index);
        let mut object = object.clone();
        object.sub_number = again.and_then(|again| again.sub_number);
        assert!(
            again == Some(&object),
            "object {index:04X}h differs:\n{object:?}\nis now\n{again:?}\nin\n{written}"
        );
    }
    let more = after.objects.keys();
    let more = more.filter(|index| !before.objects.contains_key(index));
    assert_eq!(
        more.collect::<Vec<_>>(),
        [&0; 0],
        "new objects in\n{written}"
    );
}

/// Every finding belongs to a rule, has a message and a help, and is at a place of the text; they are in the
/// order of the text.
pub(super) fn said(findings: &[Finding], text: &str) {
    let mut last = 0;
    for finding in findings {
        let finding = say(finding, &Eds);
        let code = finding.code;
        assert!(check::rule(code).is_some(), "{code} is not a rule");
        assert!(
            !finding.message.is_empty() && !finding.help.is_empty(),
            "{code}"
        );
        let labels = finding.labels.iter().map(|label| label.span);
        for span in finding.span.into_iter().chain(labels) {
            let range = span.start as usize..span.end as usize;
            let is_valid = text.get(range).is_some() && span.line > 0 && span.column > 0;
            assert!(is_valid, "{code} is outside the text: {span:?}");
        }
        let line = finding.span.map_or(u32::MAX, |span| span.line);
        assert!(last <= line, "{code} is not in the order of the text");
        last = line;
    }
}
