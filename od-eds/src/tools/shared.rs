//! What the readers of several tools have in common.

/// The node ID for which a tool reads a file.
pub(crate) const NODE_ID: i128 = 1;

/// A section by its name, as python-canopen and others that took over its patterns tell them apart.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) enum Names {
    Object(u32),
    Member(u32, u32),
    /// `[2000Name]`, whatever follows.
    NamesOf(u32),
    Dummies,
    Other,
}

impl Names {
    pub(crate) fn of(name: &str) -> Self {
        if matches!(
            name,
            "DummyUsage" | "dummyUsage" | "Dummyusage" | "dummyusage"
        ) {
            return Self::Dummies;
        }
        let is_hex =
            |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_hexdigit());
        let Some((index, rest)) = name.split_at_checked(4).filter(|(index, _)| is_hex(index))
        else {
            return Self::Other;
        };
        let index = u32::from_str_radix(index, 16).unwrap_or(0);
        if rest.is_empty() {
            return Self::Object(index);
        }
        if rest.starts_with("Name") {
            return Self::NamesOf(index);
        }
        let sub = rest
            .strip_prefix(['S', 's', '|'])
            .and_then(|rest| rest.strip_prefix("ub"));
        match sub.filter(|sub| is_hex(sub)) {
            Some(sub) => Self::Member(index, u32::from_str_radix(sub, 16).unwrap_or(u32::MAX)),
            None => Self::Other,
        }
    }
}
