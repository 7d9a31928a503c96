//! EDS and DCF text: any text is read, a written text reads the same, and its valid part runs
//! as a device.

use od_eds::{Description, Finding, Tables};
use od_runtime::{Frame, Instant};
use od_sim::{Bus, EdsOptions, VirtualDevice};

use crate::files::files;
use crate::sent::owner;
use crate::target::Target;

pub(super) const TARGET: Target = Target {
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
    for folder in ["tests/eds", "tests/interop", "crates/od-eds/cases"] {
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
    let text = od_eds::decode(input);
    let parsed = od_eds::load(&text);
    written_again(&parsed.description);
    let tables = Tables::new(&parsed.description);
    let dictionary = tables.dictionary();
    for entry in dictionary.entries() {
        assert_eq!(dictionary.find(entry.address), Ok(entry));
    }
    said(&parsed.findings);
    let options = EdsOptions {
        lenient: true,
        ..EdsOptions::default()
    };
    let Ok(device) = VirtualDevice::from_eds(&text, options) else {
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

/// A written description reads the same, and is written the same again.
pub(super) fn written_again(description: &Description) {
    let written = od_eds::write(description);
    let again = od_eds::parse(&written).description;
    same(description, &again, &written);
    let twice = od_eds::write(&again);
    assert!(
        twice == written,
        "written again, the text differs:\n{written}\n{twice}"
    );
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

/// Every finding has a message.
pub(super) fn said(findings: &[Finding]) {
    for finding in findings {
        assert!(!od_eds::say(finding, &od_eds::Eds).message.is_empty());
    }
}
