//! Templates: texts with gaps such as `{{name}}`.

/// Path and text of a file, both with gaps.
pub(super) type Template = (&'static str, &'static str);

/// Name of a gap and its content.
pub(super) type Gap = (&'static str, String);

/// Fills the gaps of files.
pub(super) fn fill(templates: &[Template], gaps: &[Gap]) -> Vec<(String, Vec<u8>)> {
    let file = |(path, content): &Template| (text(path, gaps), text(content, gaps).into_bytes());
    templates.iter().map(file).collect()
}

/// Fills the gaps of a text. The content of a gap is not searched for gaps.
pub(super) fn text(template: &str, gaps: &[Gap]) -> String {
    let mut filled = String::new();
    let mut rest = template;
    while let Some((before, name, after)) = gap(rest) {
        filled.push_str(before);
        let found = gaps.iter().find(|(known, _)| *known == name);
        filled.push_str(found.map_or("", |(_, text)| text));
        rest = after;
    }
    filled + rest
}

/// Text before the first gap, its name, and the text after it.
fn gap(text: &str) -> Option<(&str, &str, &str)> {
    let (before, rest) = text.split_once("{{")?;
    let (name, after) = rest.split_once("}}")?;
    Some((before, name, after))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gaps_are_filled_once() {
        let gaps = [("name", "{{title}}".to_owned()), ("title", "x".to_owned())];
        let made = fill(&[("src/{{name}}", "a {{title}}, {{name}}{{none}}.")], &gaps);
        let file = ("src/{{title}}".to_owned(), b"a x, {{title}}.".to_vec());
        assert_eq!(made, [file]);
    }
}
