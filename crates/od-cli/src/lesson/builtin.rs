//! The embedded lessons; they are available without the repository.

/// Language of the text of a lesson.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, clap::ValueEnum)]
pub(super) enum Language {
    #[default]
    En,
    De,
}

impl Language {
    /// The folder beside a lesson that has its translation; `None` for the language of the lesson itself.
    pub(super) fn folder(self) -> Option<&'static str> {
        match self {
            Self::En => None,
            Self::De => Some("de"),
        }
    }
}

/// Name and text of each lesson, in order.
pub(super) const LESSONS: &[(&str, &str)] = &[
    (
        "boot-up-and-heartbeat",
        include_str!("../../lessons/01-boot-up-and-heartbeat.md"),
    ),
    ("nmt", include_str!("../../lessons/02-nmt.md")),
    ("sdo", include_str!("../../lessons/03-sdo.md")),
    ("aborts", include_str!("../../lessons/04-aborts.md")),
    ("guarding", include_str!("../../lessons/05-guarding.md")),
    ("pdo-sync", include_str!("../../lessons/06-pdo-sync.md")),
    ("mapping", include_str!("../../lessons/07-mapping.md")),
    ("scaling", include_str!("../../lessons/08-scaling.md")),
    ("store", include_str!("../../lessons/09-store.md")),
    ("lss", include_str!("../../lessons/10-lss.md")),
    ("emcy", include_str!("../../lessons/11-emcy.md")),
    ("gear", include_str!("../../lessons/12-gear.md")),
    (
        "find-silent-node",
        include_str!("../../lessons/13-find-silent-node.md"),
    ),
    (
        "find-terminator",
        include_str!("../../lessons/14-find-terminator.md"),
    ),
    (
        "find-two-nodes",
        include_str!("../../lessons/15-find-two-nodes.md"),
    ),
    ("byte-order", include_str!("../../lessons/16-byte-order.md")),
    (
        "new-encoder",
        include_str!("../../lessons/17-new-encoder.md"),
    ),
    (
        "preset-then-save",
        include_str!("../../lessons/18-preset-then-save.md"),
    ),
    (
        "silent-event-timer",
        include_str!("../../lessons/19-silent-event-timer.md"),
    ),
    ("plc-1000h", include_str!("../../lessons/20-plc-1000h.md")),
    (
        "three-with-one-id",
        include_str!("../../lessons/21-three-with-one-id.md"),
    ),
    ("bus-at-95", include_str!("../../lessons/22-bus-at-95.md")),
    (
        "error-counters",
        include_str!("../../lessons/23-error-counters.md"),
    ),
    (
        "transmission-types",
        include_str!("../../lessons/24-transmission-types.md"),
    ),
    ("sdo-block", include_str!("../../lessons/25-sdo-block.md")),
    (
        "without-a-master",
        include_str!("../../lessons/26-without-a-master.md"),
    ),
    (
        "arbitration",
        include_str!("../../lessons/27-arbitration.md"),
    ),
    (
        "drive-states",
        include_str!("../../lessons/28-drive-states.md"),
    ),
    ("io-process", include_str!("../../lessons/29-io-process.md")),
    ("master", include_str!("../../lessons/30-master.md")),
    (
        "does-not-follow",
        include_str!("../../lessons/31-does-not-follow.md"),
    ),
    ("rpdo-link", include_str!("../../lessons/32-rpdo-link.md")),
    ("bus-length", include_str!("../../lessons/33-bus-length.md")),
];

/// Name and German translation of each lesson that has one.
const GERMAN: &[(&str, &str)] = &[
    (
        "boot-up-and-heartbeat",
        include_str!("../../lessons/de/01-boot-up-and-heartbeat.md"),
    ),
    ("nmt", include_str!("../../lessons/de/02-nmt.md")),
    ("sdo", include_str!("../../lessons/de/03-sdo.md")),
    ("aborts", include_str!("../../lessons/de/04-aborts.md")),
    ("guarding", include_str!("../../lessons/de/05-guarding.md")),
    ("pdo-sync", include_str!("../../lessons/de/06-pdo-sync.md")),
    ("mapping", include_str!("../../lessons/de/07-mapping.md")),
    ("scaling", include_str!("../../lessons/de/08-scaling.md")),
    ("store", include_str!("../../lessons/de/09-store.md")),
    ("lss", include_str!("../../lessons/de/10-lss.md")),
    ("emcy", include_str!("../../lessons/de/11-emcy.md")),
    ("gear", include_str!("../../lessons/de/12-gear.md")),
    (
        "find-silent-node",
        include_str!("../../lessons/de/13-find-silent-node.md"),
    ),
    (
        "find-terminator",
        include_str!("../../lessons/de/14-find-terminator.md"),
    ),
    (
        "find-two-nodes",
        include_str!("../../lessons/de/15-find-two-nodes.md"),
    ),
    (
        "byte-order",
        include_str!("../../lessons/de/16-byte-order.md"),
    ),
    (
        "new-encoder",
        include_str!("../../lessons/de/17-new-encoder.md"),
    ),
    (
        "preset-then-save",
        include_str!("../../lessons/de/18-preset-then-save.md"),
    ),
    (
        "silent-event-timer",
        include_str!("../../lessons/de/19-silent-event-timer.md"),
    ),
    (
        "plc-1000h",
        include_str!("../../lessons/de/20-plc-1000h.md"),
    ),
    (
        "three-with-one-id",
        include_str!("../../lessons/de/21-three-with-one-id.md"),
    ),
    (
        "bus-at-95",
        include_str!("../../lessons/de/22-bus-at-95.md"),
    ),
    (
        "error-counters",
        include_str!("../../lessons/de/23-error-counters.md"),
    ),
    (
        "transmission-types",
        include_str!("../../lessons/de/24-transmission-types.md"),
    ),
    (
        "sdo-block",
        include_str!("../../lessons/de/25-sdo-block.md"),
    ),
    (
        "without-a-master",
        include_str!("../../lessons/de/26-without-a-master.md"),
    ),
    (
        "arbitration",
        include_str!("../../lessons/de/27-arbitration.md"),
    ),
    (
        "drive-states",
        include_str!("../../lessons/de/28-drive-states.md"),
    ),
    (
        "io-process",
        include_str!("../../lessons/de/29-io-process.md"),
    ),
    ("master", include_str!("../../lessons/de/30-master.md")),
    (
        "does-not-follow",
        include_str!("../../lessons/de/31-does-not-follow.md"),
    ),
    (
        "rpdo-link",
        include_str!("../../lessons/de/32-rpdo-link.md"),
    ),
    (
        "bus-length",
        include_str!("../../lessons/de/33-bus-length.md"),
    ),
];

/// Returns the translation of the lesson with this name, if there is one in this language.
pub(super) fn translation(name: &str, language: Language) -> Option<&'static str> {
    let all = match language {
        Language::En => &[],
        Language::De => GERMAN,
    };
    let (_, text) = all.iter().find(|(known, _)| *known == name)?;
    Some(text)
}

/// Returns the text of the lesson with this name.
pub(super) fn find(name: &str) -> Option<&'static str> {
    let (_, text) = LESSONS.iter().find(|(known, _)| *known == name)?;
    Some(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Names of the lessons in a folder of the repository: `01-name.md` is `name`.
    fn names(folder: &str) -> Vec<String> {
        let folder = format!("{}/../../playground/{folder}", env!("CARGO_MANIFEST_DIR"));
        let files = std::fs::read_dir(folder).expect("the lessons are there");
        let name = |file: std::io::Result<std::fs::DirEntry>| {
            let file = file.expect("an entry").file_name();
            let name = file.to_str()?.strip_suffix(".md")?;
            Some(String::from(name.get(3..).expect("`01-name.md`")))
        };
        files.filter_map(name).collect()
    }

    #[test]
    fn every_lesson_of_the_repository_is_embedded() {
        for name in names("lessons") {
            assert!(find(&name).is_some(), "{name} is missing in LESSONS");
        }
        for name in names("lessons/de") {
            let is_there = translation(&name, Language::De).is_some();
            assert!(is_there, "{name} is missing in GERMAN");
        }
    }
}
