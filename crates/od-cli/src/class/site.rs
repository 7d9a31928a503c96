//! The files of the page, with the lessons of the trainer among them.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use serde_json::{Value, json};
use sha2::{Digest, Sha256};

use super::http::Answer;
use crate::failure::{Failure, read_error};
use crate::lesson::builtin::Language;
use crate::lesson::file::Texts;

/// The page, in a program that was built with it.
const PAGE: &[(&str, &[u8])] = include!(concat!(env!("OUT_DIR"), "/page.rs"));

/// Folder of the page that `cargo xtask play` makes, in a checkout.
const BUILT: &str = "playground/web/dist";

/// Largest file of the page, in bytes.
const LARGEST: u64 = 32 * 1024 * 1024;

struct File {
    kind: &'static str,
    bytes: Vec<u8>,
    /// Changes with its content.
    version: String,
}

/// All files, by name, in memory: a request reaches no other file.
pub(super) struct Site {
    files: BTreeMap<String, File>,
    language: Option<Language>,
}

impl Site {
    /// Reads the page of this folder. Without a folder it is the page in the program, or that of the checkout. `language` is
    /// that of a page whose address names none.
    ///
    /// # Errors
    /// The folder does not contain the page.
    pub(super) fn read(folder: Option<&Path>, language: Option<Language>) -> Result<Self, Failure> {
        let mut site = Self {
            files: BTreeMap::new(),
            language,
        };
        match folder {
            None if !PAGE.is_empty() => {
                for (name, bytes) in PAGE {
                    site.add(name, bytes.to_vec());
                }
            }
            None if !Path::new(BUILT).join("index.html").is_file() => {
                return Err(Failure::Usage(format!(
                    "this odkit was built without its page; run `cargo xtask play --no-serve` and `odkit class` in the \
                     checkout, or give a folder with the page: --page {BUILT}"
                )));
            }
            other => site.add_folder(other.unwrap_or(Path::new(BUILT)))?,
        }
        for name in ["index.html", "trainer.html"] {
            let page = site.files.get(name);
            let text = page.map(|file| String::from_utf8_lossy(&file.bytes).into_owned());
            // By this mark the page knows that a class serves it.
            let marked = text.map(|text| text.replacen("<html ", "<html data-class ", 1));
            match marked {
                Some(text) if text.contains("<html data-class ") => {
                    site.add(name, text.into_bytes())
                }
                _ => {
                    let folder = folder.unwrap_or(Path::new(BUILT)).display();
                    let why = format!("{folder} is not a page of this odkit: {name} is missing");
                    return Err(Failure::Usage(why));
                }
            }
        }
        // The service worker would respond instead of the class.
        site.files.remove("sw.js");
        Ok(site)
    }

    fn add(&mut self, name: &str, bytes: Vec<u8>) {
        let digest = Sha256::digest(&bytes);
        let version = digest[..8].iter().map(|byte| format!("{byte:02x}"));
        let file = File {
            kind: kind(name),
            version: version.collect(),
            bytes,
        };
        self.files.insert(name.into(), file);
    }

    fn add_folder(&mut self, folder: &Path) -> Result<(), Failure> {
        let failed = |path: &Path, error: &std::io::Error| {
            Failure::Usage(format!("{}: {}", path.display(), read_error(error)))
        };
        let entries = fs::read_dir(folder).map_err(|error| failed(folder, &error))?;
        for path in entries.flatten().map(|entry| entry.path()) {
            let is_small = fs::metadata(&path).is_ok_and(|it| it.is_file() && it.len() <= LARGEST);
            if let Some(name) = path.file_name().and_then(|name| name.to_str())
                && is_small
            {
                self.add(
                    name,
                    fs::read(&path).map_err(|error| failed(&path, &error))?,
                );
            }
        }
        Ok(())
    }

    /// Adds lessons to the list of the page. Their names end in `.md`, so that they differ from those of other lessons.
    ///
    /// # Errors
    /// The page has no list, or two lessons have one name.
    pub(super) fn add_lessons(&mut self, lessons: Vec<Texts>) -> Result<(), Failure> {
        const LIST: &str = "lessons.json";
        let list = self.files.get(LIST);
        let mut list: Vec<Value> = list
            .and_then(|file| serde_json::from_slice(&file.bytes).ok())
            .ok_or_else(|| Failure::Usage(format!("the page has no list of lessons ({LIST})")))?;
        for Texts { path, own, german } in lessons {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            let file = |ending: &str| format!("lesson-{name}{ending}.md");
            if self.files.contains_key(&file("")) {
                let why = format!("two lessons have the name {name}; rename one of the files");
                return Err(Failure::Usage(why));
            }
            let (lesson, text) = own;
            let mut entry = json!({
                "name": name, "title": lesson.title, "summary": lesson.summary,
                "level": lesson.level, "minutes": lesson.minutes, "isOwn": true,
            });
            self.add(&file(""), text.into_bytes());
            if let Some((lesson, text)) = german {
                entry["de"] = json!({ "title": lesson.title, "summary": lesson.summary });
                self.add(&file(".de"), text.into_bytes());
            }
            list.push(entry);
        }
        self.add(LIST, Value::Array(list).to_string().into_bytes());
        Ok(())
    }

    /// The file of a path such as `/main.js`, unless the browser knows this version of it.
    pub(super) fn answer(&self, path: &str, has_query: bool, known: Option<&str>) -> Answer {
        if let ("/", false, Some(language)) = (path, has_query, self.language) {
            return Answer::elsewhere(match language {
                Language::En => "/?lang=en",
                Language::De => "/?lang=de",
            });
        }
        let name = match path {
            "/" => "index.html",
            path => path.trim_start_matches('/'),
        };
        let name = percent_decoded(name);
        match self.files.get(&name) {
            None => Answer::text(404, "not found"),
            Some(file) if known == Some(&file.version) => Answer::unchanged(&file.version),
            Some(file) => Answer::file(file.kind, file.bytes.clone(), &file.version),
        }
    }
}

/// A name of a file in a path, such as `lesson-my%20lesson.md.md`.
fn percent_decoded(text: &str) -> String {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let [first, others @ ..] = rest {
        let code = others
            .get(..2)
            .and_then(|two| std::str::from_utf8(two).ok());
        match code.and_then(|two| u8::from_str_radix(two, 16).ok()) {
            Some(byte) if *first == b'%' => {
                bytes.push(byte);
                rest = &others[2..];
            }
            _ => {
                bytes.push(*first);
                rest = others;
            }
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

/// The media type of a file.
fn kind(name: &str) -> &'static str {
    match Path::new(name).extension().and_then(|it| it.to_str()) {
        Some("html") => "text/html; charset=utf-8",
        Some("js") => "text/javascript; charset=utf-8",
        Some("css") => "text/css; charset=utf-8",
        Some("json") => "application/json",
        Some("webmanifest") => "application/manifest+json",
        Some("md") => "text/markdown; charset=utf-8",
        Some("svg") => "image/svg+xml",
        Some("wasm") => "application/wasm",
        _ => "application/octet-stream",
    }
}
