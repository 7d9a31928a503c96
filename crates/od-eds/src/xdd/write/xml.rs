//! XML text with its nesting depth.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use od_model::{Visible, is_hidden};

/// Names and values; an empty value is left out.
pub(super) type Attributes = Vec<(&'static str, String)>;

pub(super) fn vec_of<const N: usize>(pairs: [(&'static str, String); N]) -> Attributes {
    pairs.into_iter().collect()
}

/// Text and nesting depth.
pub(super) struct Xml(pub(super) String, usize);

impl Xml {
    /// Text that continues after `head`, one level deeper.
    pub(super) fn new(head: &str) -> Self {
        Self(head.into(), 1)
    }

    pub(super) fn indent(&self) -> String {
        "  ".repeat(self.1)
    }

    fn open(&mut self, name: &str, attributes: &[(&'static str, String)]) {
        let indent = self.indent();
        self.0.push_str(&format!("{indent}<{name}"));
        // An empty value gets no attribute.
        for (key, value) in attributes.iter().filter(|(_, value)| !value.is_empty()) {
            self.0.push_str(&format!(" {key}=\"{}\"", escape(value)));
        }
    }

    pub(super) fn element(
        &mut self,
        name: &str,
        attributes: &[(&'static str, String)],
        content: impl FnOnce(&mut Self),
    ) {
        self.open(name, attributes);
        self.0.push_str(">\n");
        self.1 += 1;
        content(self);
        self.1 -= 1;
        let indent = self.indent();
        self.0.push_str(&format!("{indent}</{name}>\n"));
    }

    pub(super) fn empty(&mut self, name: &str, attributes: &[(&'static str, String)]) {
        self.open(name, attributes);
        self.0.push_str("/>\n");
    }

    pub(super) fn text(&mut self, name: &str, text: &str) {
        let indent = self.indent();
        let text = escape(text);
        self.0
            .push_str(&format!("{indent}<{name}>{text}</{name}>\n"));
    }

    /// One of the two profiles of a file, with the header that ISO 15745 requires.
    pub(super) fn profile(&mut self, title: &str, class: &str, content: impl FnOnce(&mut Self)) {
        self.element("ISO15745Profile", &[], |out| {
            out.element("ProfileHeader", &[], |out| {
                out.text("ProfileIdentification", title);
                out.text("ProfileRevision", "1.1");
                out.text("ProfileName", "");
                out.text("ProfileSource", "");
                out.text("ProfileClassID", class);
                out.element("ISO15745Reference", &[], |out| {
                    out.text("ISO15745Part", "1");
                    out.text("ISO15745Edition", "1");
                    out.text("ProfileTechnology", "CANopen");
                });
            });
            content(out);
        });
    }
}

/// Escapes characters with a meaning in XML, characters that XML cannot contain, and hidden
/// characters.
pub(super) fn escape(text: &str) -> String {
    let mut out = String::new();
    for character in text.chars() {
        match character {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\t' | '\n' | '\r' => out.push_str(&format!("&#{};", character as u32)),
            '\u{FFFE}' | '\u{FFFF}' => out.push(' '),
            c if c < ' ' => out.push_str(&Visible(c.encode_utf8(&mut [0; 4])).line()),
            c if is_hidden(c) => out.push_str(&format!("&#{};", c as u32)),
            c => out.push(c),
        }
    }
    out
}
