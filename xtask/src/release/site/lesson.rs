//! A lesson as a page: its bench in a frame, its text, and hints that the learner opens.

use std::path::Path;

use super::markdown::fence;

/// The page of the playground, seen from a lesson's page.
const PLAYGROUND: &str = "../playground/index.html";

/// Name, title and text of a lesson's page; `None` if the file is not a lesson.
pub(super) fn page(text: &str, file: &Path) -> Option<(String, String, String)> {
    let stem = file.file_stem()?.to_string_lossy();
    let name = stem.split_once('-')?.1;
    let (_, rest) = text.split_once("+++\n")?;
    let (head, body) = rest.split_once("+++\n")?;
    let field = |key: &str| {
        let line = head
            .lines()
            .find_map(|line| line.strip_prefix(key)?.trim().strip_prefix('='));
        line.map(|value| value.trim().trim_matches('"'))
            .unwrap_or_default()
    };
    let title = field("title");
    let mut out = format!(
        "# {title}\n\nLevel {}, {} minutes. `odkit lesson run {name}` takes the lesson on the command line.\n\n",
        field("level"),
        field("minutes"),
    );
    out.push_str(&format!(
        "<iframe class=\"bench\" src=\"{PLAYGROUND}?embed&amp;lesson={name}\" title=\"Bench of the lesson\" \
         loading=\"lazy\"></iframe>\n\n[Open the lesson in the playground]({PLAYGROUND}?lesson={name})\n"
    ));
    out.push_str(&folded(body));
    Some((String::from(name), String::from(title), out))
}

/// The text with hints, answers and solutions in closed sections.
fn folded(text: &str) -> String {
    let mut out = String::new();
    // Whether a closed section has begun, and the fence of the current block.
    let (mut is_open, mut block) = (false, None::<&str>);
    for line in text.lines() {
        let signs = fence(line);
        let is_heading = block.is_none() && line.starts_with('#');
        let name = match (block, signs) {
            (None, Some(_)) => summary(line.trim_start_matches(['`', '~']).trim()),
            _ if line.trim() == "### Hint" && is_heading => Some("Hint"),
            _ => None,
        };
        if (is_heading || name.is_some()) && is_open {
            out.push_str("</details>\n\n");
            is_open = false;
        }
        if let Some(name) = name {
            out.push_str(&format!("<details><summary>{name}</summary>\n\n"));
            is_open = true;
        }
        match (block, signs) {
            (None, Some(signs)) => {
                block = Some(signs);
                let own = format!("{signs}text");
                out.push_str(if name.is_some() { &own } else { line });
            }
            (Some(open), Some(_)) if line.trim() == open => {
                block = None;
                out.push_str(line);
            }
            _ if name.is_some() => {}
            _ => out.push_str(line),
        }
        out.push('\n');
    }
    if is_open {
        out.push_str("\n</details>\n");
    }
    out
}

/// The heading of a block that is not part of the text.
fn summary(info: &str) -> Option<&'static str> {
    match info {
        "set-up" => Some("Bench"),
        "checkpoint" => Some("Checkpoint"),
        "answer" => Some("Answer"),
        "solution" => Some("Solution"),
        "facts" => Some("Shown by"),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::page;

    const LESSON: &str = "+++\ntitle = \"Boot-up\"\nlevel = 1\nminutes = 5\n+++\n\nIntro.\n\n```set-up\n\
                          device gxmm node 5\n```\n\n## Power it\n\nText.\n\n### Predict\n\nWhich?\n\n\
                          ```answer\n705#00\n```\n\n700h + 5.\n\n### Hint\n\nThe switch.\n\n````text\n```\n\
                          # no heading\n````\n\n### What just happened\n\nIt started.\n\n```solution\npower on\n```\n";

    #[test]
    fn a_part_with_the_solution_is_closed() {
        let (name, title, text) =
            page(LESSON, Path::new("a/01-boot-up.md")).expect("it is a lesson");
        assert_eq!((&*name, &*title), ("boot-up", "Boot-up"));
        assert!(
            text.starts_with("# Boot-up\n\nLevel 1, 5 minutes."),
            "{text}"
        );
        assert!(
            text.contains("index.html?embed&amp;lesson=boot-up\""),
            "{text}"
        );
        let open = |name: &str| format!("<details><summary>{name}</summary>\n\n");
        let bench =
            open("Bench") + "```text\ndevice gxmm node 5\n```\n\n</details>\n\n## Power it\n";
        assert!(text.contains(&bench), "{text}");
        let answer = open("Answer") + "```text\n705#00\n```\n\n700h + 5.\n\n</details>\n\n";
        assert!(text.contains(&answer), "{text}");
        let hint = open("Hint")
            + "\n\nThe switch.\n\n````text\n```\n# no heading\n````\n\n</details>\n\n### What";
        assert!(text.contains(&hint), "{text}");
        let solution = open("Solution") + "```text\npower on\n```\n\n</details>\n";
        assert!(text.ends_with(&solution), "{text}");
        assert_eq!(page("# Notes\n", Path::new("01-notes.md")), None);
    }
}
